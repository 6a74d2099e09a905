#!/usr/bin/env python3
"""bench/peers_picture.py RESULTS.jsonl OUT.svg: seconds of ndhull and Qhull on each input, as one picture.

RESULTS is what `ndhull-bench peers --json` wrote. Bars are medians on a logarithmic axis; the number behind a
pair is Qhull's time over ndhull's.
"""
import json
import math
import statistics
import sys

WIDTH, LEFT, RIGHT, ROW, TOP = 760, 170, 90, 34, 64
COLOURS = {"ndhull": "#0b6e99", "qhull": "#c9c3b8"}


def medians(path):
    """Input name -> engine -> median seconds, in the order of the file."""
    seconds = {}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            run = json.loads(line)
            if run["engine"] in COLOURS and run["end"] == "done":
                seconds.setdefault(run["input"], {}).setdefault(run["engine"], []).append(run["wall_seconds"])
    return {name: {engine: statistics.median(values) for engine, values in engines.items()}
            for name, engines in seconds.items() if len(engines) == len(COLOURS)}


def picture(rows):
    """The SVG text."""
    low = math.floor(math.log10(min(min(row.values()) for row in rows.values())))
    high = math.ceil(math.log10(max(max(row.values()) for row in rows.values())))
    scale = (WIDTH - LEFT - RIGHT) / (high - low)
    height = TOP + ROW * len(rows) + 40

    def x(value):
        return LEFT + (math.log10(value) - low) * scale

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" '
           'font-size="13">', f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
           '<text x="12" y="24" font-size="16">Seconds for the exact hull, one thread (shorter is better)</text>']
    for place, (engine, label) in enumerate((("ndhull", "ndhull, with certificate"), ("qhull", "Qhull 2020.2"))):
        out.append(f'<rect x="{LEFT + 190 * place}" y="36" width="12" height="12" fill="{COLOURS[engine]}"/>'
                   f'<text x="{LEFT + 18 + 190 * place}" y="47">{label}</text>')
    for power in range(low, high + 1):
        at = LEFT + (power - low) * scale
        out.append(f'<line x1="{at:.1f}" y1="{TOP - 6}" x2="{at:.1f}" y2="{height - 30}" stroke="#dddddd"/>'
                   f'<text x="{at:.1f}" y="{height - 12}" text-anchor="middle">{10.0 ** power:g} s</text>')
    for index, (name, row) in enumerate(rows.items()):
        y = TOP + ROW * index
        out.append(f'<text x="{LEFT - 10}" y="{y + 19}" text-anchor="end">{name}</text>')
        for place, engine in enumerate(("ndhull", "qhull")):
            out.append(f'<rect x="{LEFT}" y="{y + 3 + 12 * place}" width="{x(row[engine]) - LEFT:.1f}" height="11" '
                       f'fill="{COLOURS[engine]}"/>')
        out.append(f'<text x="{max(x(value) for value in row.values()) + 8:.1f}" y="{y + 19}">'
                   f'{row["qhull"] / row["ndhull"]:.1f} times</text>')
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    results, target = sys.argv[1:]
    with open(target, "w", encoding="utf-8") as out:
        out.write(picture(medians(results)))


if __name__ == "__main__":
    main()
