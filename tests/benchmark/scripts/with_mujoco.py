"""A sweep by a script with MuJoCo's kinematics: it places the links and has their Jacobians and
the rates of these; loops are closed by Newton's method (`sweep.py`), not by its soft constraints.
"""

import sys
from pathlib import Path
from xml.etree import ElementTree

sys.path.insert(0, str(Path(__file__).resolve().parent))

try:
    import mujoco
    import numpy as np
except ImportError as error:
    sys.exit(f"left out: {error.name} is not installed (pip install mujoco)")

from sweep import run

KINDS = {"R": "hinge", "P": "slide"}


class Tree:
    """The hinges and slides as bodies of the library, the spots as its sites."""

    def __init__(self, problem):
        root = ElementTree.Element("mujoco")
        ElementTree.SubElement(root, "compiler", angle="radian")
        world = ElementTree.SubElement(root, "worldbody")
        bodies, at = [], []
        for joint in problem["joints"]:
            parent = joint["parent"]
            above = world if parent < 0 else bodies[parent]
            point = np.array(joint["point"], float)
            own = point if parent < 0 else point - at[parent]
            body = ElementTree.SubElement(above, "body", pos=text(own), name=joint["name"])
            kind = {"type": KINDS[joint["kind"]], "axis": text(joint["axis"])}
            ElementTree.SubElement(body, "joint", **kind)
            inertia = {"pos": "0 0 0", "mass": "1", "diaginertia": "1 1 1"}
            ElementTree.SubElement(body, "inertial", **inertia)
            bodies.append(body)
            at.append(point)
        for number, spot in enumerate(problem["spots"]):
            joint, place = spot["joint"], np.array(spot["place"], float)
            above = world if joint < 0 else bodies[joint]
            own = place if joint < 0 else place - at[joint]
            ElementTree.SubElement(above, "site", name=f"spot{number}", pos=text(own))
        self.model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, "unicode"))
        self.data = mujoco.MjData(self.model)
        # it numbers bodies, joints and sites depth first
        names = [joint["name"] for joint in problem["joints"]]
        self.order = [int(self.model.body(name).jntadr[0]) for name in names]
        self.sites = [self.model.site(f"spot{k}").id for k in range(len(problem["spots"]))]
        self.bodies = [int(self.model.site_bodyid[site]) for site in self.sites]

    def spots(self, q):
        self.data.qpos[self.order] = q
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        columns = np.empty((len(self.bodies), 3, self.model.nv))
        for spot, site in enumerate(self.sites):
            mujoco.mj_jacSite(self.model, self.data, columns[spot], None, site)
        return self.data.site_xpos[self.sites], columns[:, :, self.order]

    def drift(self, q, rates):
        self.data.qvel[self.order] = rates
        mujoco.mj_comVel(self.model, self.data)
        rate = np.empty((3, self.model.nv))
        found = []
        for site, body in zip(self.sites, self.bodies, strict=True):
            place = self.data.site_xpos[site]
            mujoco.mj_jacDot(self.model, self.data, rate, None, place, body)
            found.append(rate @ self.data.qvel)
        return np.array(found)


def text(values):
    return " ".join(repr(float(x)) for x in values)


if __name__ == "__main__":
    run(Tree)
