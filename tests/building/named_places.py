"""A mechanism file in which names stand wherever coordinates stood."""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]


class Names:
    """Gives every place of a file a name: half of the names lead by way of another point."""

    def __init__(self, data: Data) -> None:
        self.points: Data = data.setdefault("points", {})
        self.count = 0

    def of(self, link: str, place: Any) -> Any:
        """The name of a point of a link at a place; what is a name already stays."""
        if isinstance(place, str):
            return place
        self.count += 1
        name = f"place_{self.count}"
        if self.count % 2:
            self.points[name] = {"link": link, "at": place}
            return name
        # behind it in the file: the order of points does not matter
        self.points[name] = {"link": link, "at": f"{name}_too"}
        self.points[f"{name}_too"] = {"link": "ground", "at": place}
        return name


def with_named_places(data: Data) -> int:
    """Replaces every place of the file; how many there were."""
    names = Names(data)
    for joint in data.get("joints", {}).values():
        point = joint.get("point")
        if isinstance(point, dict):
            joint["point"] = {link: names.of(link, place) for link, place in point.items()}
        elif point is not None:
            joint["point"] = names.of(joint["links"][1], point)
    for name, link in data.get("links", {}).items():
        if link and "center_of_mass" in link:
            link["center_of_mass"] = names.of(name, link["center_of_mass"])
    for load in data.get("loads", ()):
        if "point" in load:
            link = load["link"] if "link" in load else load["links"][1]
            load["point"] = names.of(link, load["point"])
    for name, shape in data.get("view", {}).get("shapes", {}).items():
        if isinstance(shape, dict) and "points" in shape:
            shape["points"] = [names.of(name, place) for place in shape["points"]]
    return names.count
