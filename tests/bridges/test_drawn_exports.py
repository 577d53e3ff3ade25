"""glTF, DXF and Parquet as others read them: the same places as mechkin's own columns."""

from __future__ import annotations

import io
import json
import os
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import ExportOptions, exported
from mechkin_cli.diagnostics import UsageError

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
SPACE, PLANE = "dissertation/rcsr", "plane/planar_four_bar"
CAM = "../mechkin_cli/templates/cam"
NAMES = (
    *(SPACE, PLANE),
    *("classics/stewart", "three_link_paper/cspc", "couplings/cylinder_boom")
    * ("MECHKIN_RANDOM" in os.environ),
)


def files_of(model: mk.Model, format_: str, **options: Any) -> dict[str, bytes]:
    return dict(exported(model, format_, ExportOptions(**options)).files)


def rotated(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """By quaternions with the scalar last."""
    v, w = quaternion[..., :3], quaternion[..., 3:]
    return vector + 2.0 * (w * np.cross(v, vector) + np.cross(v, np.cross(v, vector)))


def points_of(model: mk.Model) -> dict[str, tuple[str, np.ndarray, np.ndarray]]:
    """Of moving named points: the link, the place in the drawing and its places over the rows (m),
    by mechkin's own columns."""
    mechanism = model.problem.mechanism
    names = [name for name, at in mechanism.points.items() if at.link != "ground"]
    run = model.analyze([f"{name}.position" for name in names], tables=[])
    metre = float(model.problem.units.to_si(1.0, mk.units.LENGTH))
    found = {}
    for name in names:
        places = run[f"{name}.position"] * metre
        places = np.pad(places, ((0, 0), (0, 3 - places.shape[1])))
        at = mechanism.points[name]
        found[name] = at.link, np.array(at.vector), places
    return found


def accessor(tree: dict[str, Any], binary: bytes, number: int) -> np.ndarray:
    one = tree["accessors"][number]
    view = tree["bufferViews"][one["bufferView"]]
    wide = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[one["type"]]
    values = np.frombuffer(binary, "<f4", one["count"] * wide, view["byteOffset"])
    return values.reshape(-1, wide).astype(float)


@pytest.mark.parametrize("name", NAMES)
def test_an_animation_has_the_poses_of_all_rows(name: str) -> None:
    gltf = pytest.importorskip("pygltflib")
    model = mk.load(MECHANISMS / f"{name}.yaml")
    (content,) = files_of(model, "gltf").values()
    read = gltf.GLTF2.load_from_bytes(content)
    tree, binary = json.loads(read.to_json()), read.binary_blob()
    numbers = {node.name: k for k, node in enumerate(read.nodes)}
    (animation,) = read.animations
    keys: dict[tuple[int, str], np.ndarray] = {}
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        assert sampler.interpolation == "LINEAR"
        times = accessor(tree, binary, sampler.input)[:, 0]
        assert times[0] == 0.0
        assert (np.diff(times) > 0.0).all()
        keys[channel.target.node, channel.target.path] = accessor(tree, binary, sampler.output)
    size = model.problem.mechanism.box_diagonal()
    points = points_of(model)
    assert points
    for link, drawn, places in points.values():
        node = numbers[link]
        turned = rotated(keys[node, "rotation"], drawn) + keys[node, "translation"]
        known = np.isfinite(places).all(axis=1)
        assert np.abs(turned - places[known]).max() < 1e-5 * size
    # each mesh is there, of finite corners within the reach of the mechanism
    for mesh in read.meshes:
        corners = accessor(tree, binary, mesh.primitives[0].attributes.POSITION)
        assert np.isfinite(corners).all()
        assert len(corners) % 3 == 0


def test_trimesh_reads_closed_meshes() -> None:
    trimesh = pytest.importorskip("trimesh")
    (content,) = files_of(mk.load(MECHANISMS / f"{SPACE}.yaml"), "gltf").values()
    scene = trimesh.load(io.BytesIO(content), file_type="glb")
    assert {"crank", "coupler", "rocker"} <= set(scene.geometry)
    for mesh in scene.geometry.values():
        mesh.merge_vertices(merge_norm=True)
        assert mesh.is_watertight
        assert mesh.volume > 0.0


def test_the_validator_of_khronos_finds_nothing(tmp_path: Path) -> None:
    """`npm install gltf-validator`, in a folder that MECHKIN_NODE names."""
    folder = os.environ.get("MECHKIN_NODE", "")
    if not (shutil.which("node") and Path(folder, "node_modules/gltf-validator").is_dir()):
        pytest.skip("no validator; MECHKIN_NODE names the folder of its node_modules")
    script = (
        "const v=require('gltf-validator'),fs=require('fs');"
        "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])))"
        ".then(r=>console.log(JSON.stringify(r.issues)))"
    )
    for name in NAMES:
        (content,) = files_of(mk.load(MECHANISMS / f"{name}.yaml"), "gltf").values()
        file = tmp_path / "one.glb"
        file.write_bytes(content)
        words = ["node", "-e", script, str(file)]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
        issues = json.loads(done.stdout)
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


def test_a_container_is_whole() -> None:
    (content,) = files_of(mk.load(MECHANISMS / f"{PLANE}.yaml"), "gltf", rows=(1, 5, 9)).values()
    magic, version, length = struct.unpack("<4sII", content[:12])
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack("<II", content[12:20])
    assert kind == 0x4E4F534A
    assert size % 4 == 0
    tree = json.loads(content[20 : 20 + size])
    (animation,) = tree["animations"]
    assert tree["accessors"][animation["samplers"][0]["input"]]["count"] == 3


@pytest.mark.parametrize("name", [SPACE, PLANE, CAM])
def test_a_drawing_has_paths_links_and_cams(name: str) -> None:
    pytest.importorskip("ezdxf")
    from ezdxf import recover

    model = mk.load(MECHANISMS / f"{name}.yaml")
    (content,) = files_of(model, "dxf").values()
    assert files_of(model, "dxf") == {f"{model.stem}.dxf": content}, "the same bytes"
    document, audit = recover.read(io.BytesIO(content))
    assert not audit.has_errors
    assert not audit.has_fixes
    space = document.modelspace()
    by_layer: dict[str, list[Any]] = {}
    for entity in space:
        by_layer.setdefault(entity.dxf.layer, []).append(entity)
    assert by_layer["JOINTS"]
    metre = float(model.problem.units.to_si(1.0, mk.units.LENGTH))
    for point, (link, _, places) in points_of(model).items():
        (line,) = by_layer[f"PATH {point}"]
        if line.dxftype() == "LWPOLYLINE":
            drawn = np.array([p[:2] for p in line.get_points()])
        else:
            drawn = np.array([tuple(v.dxf.location) for v in line.vertices])
        known = places[np.isfinite(places).all(axis=1)] / metre
        off = np.abs(drawn - known[:, : drawn.shape[1]])
        assert off.max() < 1e-9 * np.abs(known).max()
        assert f"LINK {link}" in by_layer
    for coupling in model.problem.mechanism.couplings:
        cam = model.cam(coupling)
        (line,) = by_layer[f"CAM {coupling}"]
        drawn = np.array([p[:2] for p in line.get_points()])
        own = np.asarray(cam.profile)[:, :-1].T if cam.is_closed else np.asarray(cam.profile).T
        assert line.closed == cam.is_closed
        assert np.abs((drawn - drawn[0]) - (own - own[0])).max() < 1e-9 * np.abs(own).max()


def test_a_frame_has_the_columns_of_the_run() -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    polars = pytest.importorskip("polars")
    model = mk.load(MECHANISMS / f"{SPACE}.yaml")
    files = files_of(model, "parquet")
    assert list(files) == ["rcsr.sweep.parquet"]
    (content,) = files.values()
    table = parquet.read_table(io.BytesIO(content))
    run = model.analyze()
    for name in ("O4.theta", "O4.theta_dot", "O1.effort"):
        assert np.array_equal(table.column(name).to_numpy(), run[name], equal_nan=True)
        assert table.schema.field(name).metadata[b"unit"].decode() == run.unit(name)
    columns = {column.label: column for one in run.tables for column in one.columns}
    assert np.array_equal(table.column("FB").to_numpy(), columns["FB"].numbers)
    frame = polars.read_parquet(io.BytesIO(content))
    assert frame["row.status"].to_list() == [str(word) for word in run["row.status"]]
    metre = float(model.problem.units.to_si(1.0, mk.units.LENGTH))
    for link, drawn, places in points_of(model).values():
        words = ("x", "y", "z", "q0", "q1", "q2", "q3")
        pose = np.stack([frame[f"{link}.pose.{word}"].to_numpy() for word in words], axis=1)
        turn = np.roll(pose[:, 3:], -1, axis=1)
        assert np.abs(rotated(turn, drawn / metre) + pose[:, :3] - places / metre).max() < 1e-12
    (some,) = files_of(model, "parquet", rows=(2, 4)).values()
    assert parquet.read_table(io.BytesIO(some)).column("row").to_pylist() == [2, 4]


@pytest.mark.parametrize("format_", ["gltf", "dxf", "parquet", "loads"])
def test_a_row_that_is_not_there_is_refused(format_: str) -> None:
    if format_ == "dxf":
        pytest.importorskip("ezdxf")
    with pytest.raises(UsageError, match="has 25 rows"):
        exported(mk.load(MECHANISMS / f"{PLANE}.yaml"), format_, ExportOptions(rows=(99,)))
