"""What qhull and ndhull qhull print, as facets."""


def numbers(line):
    return [float(word) for word in line.split()]


def rows_of(text, skip):
    return [[int(word) for word in line.split()] for line in text.splitlines()[skip:]]


# Lines of a format, by the lines from its first one on.
COUNTED = {"n": lambda lines: 2 + int(lines[1]), "FS": lambda lines: 2, "Fs": lambda lines: 2, "FV": lambda lines: 2}


def parts_of(text, formats):
    """The lines of each of the formats that one run printed; all others begin with how many lines follow."""
    lines, parts = text.splitlines(), {}
    for name in formats:
        count = COUNTED.get(name, lambda rest: 1 + int(rest[0]))(lines)
        parts[name], lines = lines[:count], lines[count:]
    assert not lines, lines[:5]
    return parts


class Facets:
    """Facets by the sets of their vertices, from the formats of one run."""

    def __init__(self, program, stdin, options=""):
        formats = ["Fv", "n", "Fa", "Fn", "FS", "Fx", "Fs", "FN", "FV"]
        parts = parts_of(program(f"{options} {' '.join(formats)}".strip(), stdin), formats)

        def rows(name):
            return [[int(word) for word in line.split()] for line in parts[name][1:]]

        self.vertices = [frozenset(row[1:]) for row in rows("Fv")]
        assert len(set(self.vertices)) == len(self.vertices)
        self.planes = dict(zip(self.vertices, map(numbers, parts["n"][2:]), strict=True))
        self.areas = dict(zip(self.vertices, map(float, parts["Fa"][1:]), strict=True))
        self.neighbours = {
            facet: {self.vertices[other] for other in row[1:]}
            for facet, row in zip(self.vertices, rows("Fn"), strict=True)
        }
        self.size = numbers(parts["FS"][1])
        self.extreme = sorted(parts["Fx"][1:])
        self.counts = numbers(parts["Fs"][0])
        self.of_points = [{self.vertices[facet] for facet in row[1:]} for row in rows("FN")]
        self.centre = numbers(parts["FV"][1])
