"""A sweep by a script with Pinocchio: it places the links and has their Jacobians (`sweep.py`)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

try:
    import numpy as np
    import pinocchio as pin
except ImportError as error:
    sys.exit(f"left out: {error.name} is not installed (pip install pin)")

from sweep import run


class Tree:
    """The hinges and slides as joints of the library, the spots as its frames."""

    def __init__(self, problem):
        self.model = pin.Model()
        kinds = {"R": pin.JointModelRevoluteUnaligned, "P": pin.JointModelPrismaticUnaligned}
        index, at = [], []
        for joint in problem["joints"]:
            axis, point = np.array(joint["axis"], float), np.array(joint["point"], float)
            parent = joint["parent"]
            last = np.zeros(3) if parent < 0 else at[parent]
            above = 0 if parent < 0 else index[parent]
            place = pin.SE3(np.eye(3), point - last)
            kind = kinds[joint["kind"]](axis / np.linalg.norm(axis))
            index.append(self.model.addJoint(above, kind, place, joint["name"]))
            at.append(point)
        self.frames = []
        for number, spot in enumerate(problem["spots"]):
            joint, place = spot["joint"], np.array(spot["place"], float)
            own = place if joint < 0 else place - at[joint]
            above = 0 if joint < 0 else index[joint]
            frame = pin.Frame(
                f"spot{number}", above, pin.SE3(np.eye(3), own), pin.FrameType.OP_FRAME
            )
            self.frames.append(self.model.addFrame(frame))
        self.data = self.model.createData()
        self.still = np.zeros(self.model.nv)

    def spots(self, q):
        pin.computeJointJacobians(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        places = [self.data.oMf[frame].translation for frame in self.frames]
        columns = [
            pin.getFrameJacobian(self.model, self.data, frame, axes)[:3] for frame in self.frames
        ]
        return np.array(places), np.array(columns)

    def drift(self, q, rates):
        pin.forwardKinematics(self.model, self.data, q, rates, self.still)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return np.array(
            [
                pin.getFrameClassicalAcceleration(self.model, self.data, frame, axes).linear
                for frame in self.frames
            ]
        )


if __name__ == "__main__":
    run(Tree)
