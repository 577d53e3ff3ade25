// What is drawn, with changed dimensions: the numbers of the drawing that hang on parameters are put into a copy of it.

/**
 * The parts of the data that differ.
 * @param drawing  {first, places: [[path, slot, factor]]}: where in the data a number stands, which of the computed numbers
 *   it is, counted from `first`, and the file's unit in SI that it is divided by
 * @param numbers  what was computed of the parameters
 */
export function drawnWith(data, { first, places }, numbers) {
  const copies = new Map();
  const drawn = {};
  const copyOf = (original, key, put) => {
    if (!copies.has(key)) {
      const made = Array.isArray(original) ? [...original] : { ...original };
      copies.set(key, made);
      put(made);
    }
    return copies.get(key);
  };
  for (const [path, slot, factor] of places) {
    let [source, target, key] = [data, drawn, ""];
    for (const step of path.slice(0, -1)) {
      source = source[step];
      key += `/${step}`;
      const into = target;
      target = copyOf(source, key, (made) => (into[step] = made));
    }
    target[path.at(-1)] = numbers[first + slot] / factor;
  }
  return drawn;
}
