#!/bin/sh
# Builds the kernel with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests, hostile calls first.
#
#   tests/kernel/sanitized.sh [FOLDER [COUNT]]
#
# FOLDER keeps the build (a temporary one otherwise); COUNT: how many hostile trials of each kind. Needs g++ with
# libasan, and a Python with the project's build and test requirements (PYTHON, python3 otherwise). About four minutes
# on two cores, the build included.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
python=${PYTHON:-python3}
folder=${1:-$(mktemp -d)}
mkdir -p "$folder/package"

"$python" -m cmake -S "$here/mechkin_cli/kernel" -B "$folder/build" -G Ninja -DMECHKIN_SANITIZE=ON \
  -DCMAKE_BUILD_TYPE=None -Dnanobind_DIR="$("$python" -m nanobind --cmake_dir)" \
  -DPython_EXECUTABLE="$("$python" -c 'import sys; print(sys.executable)')" > "$folder/configure.log"
"$python" -m cmake --build "$folder/build" > "$folder/build.log"

rm -rf "$folder/package/mechkin_cli"
cp -r "$here/mechkin_cli" "$folder/package/"
rm -f "$folder"/package/mechkin_cli/kernel/_kernel*.so
cp "$folder"/build/python/_kernel*.so "$folder/package/mechkin_cli/kernel/"

# an editable installation would come before the copy
cat > "$folder/package/sitecustomize.py" <<END
import sys

sys.meta_path[:] = [f for f in sys.meta_path if "editable" not in type(f).__module__]
END

# Python itself leaks at its exit; its own allocator would hide what happens between objects
LD_PRELOAD="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)"
export LD_PRELOAD ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 PYTHONMALLOC=malloc
export UBSAN_OPTIONS=print_stacktrace=1 PYTHONPATH="$folder/package:$here/tests" PYTHONDONTWRITEBYTECODE=1
cd "$folder"
"$python" -c 'import mechkin_cli, sys; assert mechkin_cli.__file__.startswith(sys.argv[1])' "$folder/package"
for generator in hostile hostile_runs; do
  "$python" -W ignore -m "kernel.$generator" 0 "${2:-1000}" 2> "$folder/$generator.log" ||
    { tail -n 60 "$folder/$generator.log"; exit 1; }
done
# left out: tests that compile, compare whole tables in processes of their own, or check digits by mpmath
"$python" -m pytest -q -p no:cacheprovider --rootdir "$here" --durations 8 \
  "$here/tests/kernel" "$here/tests/tape" "$here/tests/variants" "$here/tests/session/test_following_rows.py" \
  --ignore "$here/tests/kernel/test_symbols.py" --ignore "$here/tests/kernel/test_linear.py" \
  --ignore "$here/tests/kernel/test_elementary.py" --ignore "$here/tests/kernel/test_bits.py" \
  --ignore "$here/tests/kernel/test_new_pair.py" \
  -k "not thousands_of_bad_calls and not refuse_bad_calls and not the_generator_would_see"
