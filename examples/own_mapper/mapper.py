"""A first mapper, as one writes it in an afternoon, with one mistake: docs/start/find-a-mistake.md.

Behind each new edge it asks: was I here before? For each unexplored exit that looks alike it walks
home as if it had come in by that exit, and compares what it sees.
"""


class Mapper:
    """The map so far, and the robot that draws it. A dart is one end of an edge, numbered."""

    def __init__(self, robot):
        self.robot, self.cost = robot, 0
        self.rows = []  # the darts of each vertex, clockwise
        self.vertex = []  # the vertex of a dart
        self.looks = []  # what a robot senses that comes in by a dart
        self.other = {}  # the other end of a dart's edge, where it is known
        self.unexplored = []

    def explore(self):
        at = self.add_vertex(self.sense())  # the dart by which the robot came, as the map has it
        while self.unexplored:
            e = self.unexplored.pop(0)
            at = self.walk(at, self.vertex[e])
            self.go(self.door(at, e))
            seen = self.sense()
            alike = [h for h in self.unexplored if self.alike(self.looks[h], seen)]
            end = next((h for h in alike if self.leads_home(h)), None)
            if end is None:
                end = self.add_vertex(seen)
            self.unexplored.remove(end)
            self.other[e], self.other[end] = end, e
            at = self.place(end)
        return {
            "vertices": self.rows or [[]],
            "edges": [[d, far] for d, far in self.other.items() if d < far],
            "marker": 0 if self.other else None,
            "cost": self.cost,
        }

    def leads_home(self, h):
        """Whether the way home from h looks as it should; if not, the robot goes back."""
        doors, arrivals = self.way(h, 0)
        for step, arrival in enumerate(arrivals):
            if step:
                self.go(doors[step - 1])
            if self.sense() != self.looks[arrival]:
                self.back(doors[:step])
                return False
        return True

    def back(self, doors):
        """Go back by the doors that led here."""
        turned = 0
        for door in reversed(doors):
            self.go(-turned)
            turned = door

    def place(self, end):
        """The dart by which the robot stands, at the end of an edge that it has judged."""
        here = self.sense()
        return end if here["marker"] is None else -here["marker"] % here["degree"]

    def sense(self):
        return {"degree": self.robot.percept.degree, "marker": self.robot.percept.marker}

    def alike(self, looks, seen):
        """Whether two places look alike, however the robot is turned."""
        same = (looks["marker"] is None) == (seen["marker"] is None)
        return same and looks["degree"] == seen["degree"]

    def go(self, door):
        self.robot.move(door % self.robot.percept.degree)
        self.cost += 1

    def add_vertex(self, seen):
        """A new vertex with its darts; the robot came in by the first one, which is returned."""
        first, degree = len(self.vertex), seen["degree"]
        self.rows.append(list(range(first, first + degree)))
        self.unexplored += self.rows[-1]
        for k in range(degree):
            marker = None if seen["marker"] is None else (seen["marker"] - k) % degree
            self.vertex.append(len(self.rows) - 1)
            self.looks.append({"degree": degree, "marker": marker})
        return first

    def door(self, at, dart):
        """The door that leads out by a dart, for a robot that came in by another one there."""
        return (dart - at) % self.looks[at]["degree"]

    def way(self, start, goal):
        """The shortest way from a dart to a vertex: doors, and the darts of arrival."""
        ways = {self.vertex[start]: ([], [start])}
        for v in (queue := [self.vertex[start]]):
            doors, arrivals = ways[v]
            for dart in self.rows[v]:
                far = self.other.get(dart)
                if far is not None and self.vertex[far] not in ways:
                    out = self.door(arrivals[-1], dart)
                    ways[self.vertex[far]] = [*doors, out], [*arrivals, far]
                    queue.append(self.vertex[far])
        return ways[goal]

    def walk(self, at, goal):
        doors, arrivals = self.way(at, goal)
        for door in doors:
            self.go(door)
        return arrivals[-1]


def explore(robot):
    return Mapper(robot).explore()
