"""ndhull hull --points-sharded in one process: the files are one point set."""

import os
import pathlib
import shutil
import subprocess

import numpy

from program import PROGRAM, fresh_folder, one_error_line, run, run_tests

FOLDER = fresh_folder("shards")


def write_parts(folder, points, cuts):
    """Rows between the cuts as part-00.npy, part-01.npy ...; all rows as whole.npy."""
    folder.mkdir()
    numpy.save(folder / "whole.npy", points)
    for number, (begin, end) in enumerate(zip([0, *cuts], [*cuts, len(points)])):
        numpy.save(folder / f"part-{number:02}.npy", points[begin:end])


def outputs(folder, name, *arguments):
    """Planes and vertices, as bytes."""
    planes, vertices = folder / f"{name}.planes.npy", folder / f"{name}.vertices.txt"
    run("hull", *arguments, "--planes", planes, "--vertices", vertices)
    return planes.read_bytes(), vertices.read_bytes()


def test_files_are_one_point_set_in_the_order_of_their_names():
    points = numpy.random.default_rng(1).normal(size=(5000, 5))
    for kind in ("float32", "float64"):
        folder = FOLDER / kind
        write_parts(folder, points.astype(kind), [100, 101, 4000])
        expected = outputs(folder, "whole", folder / "whole.npy", "--width", "5%")
        assert outputs(folder, "parts", "--points-sharded", folder / "part-*.npy", "--width", "5%") == expected


def test_formats_and_types_may_differ():
    folder = FOLDER / "mixed"
    points = numpy.random.default_rng(2).normal(size=(300, 3)).astype("float32")
    write_parts(folder, points, [100, 200])
    numpy.savetxt(folder / "part-01.csv", points[100:200], delimiter=",", fmt="%.17g")
    (folder / "part-01.npy").unlink()
    expected = outputs(folder, "whole", folder / "whole.npy")
    assert outputs(folder, "parts", "--points-sharded", folder / "part-*") == expected
    numbers = run("hull", "--points-sharded", folder / "part-*", "--format", "Fx").stdout
    assert numbers == run("hull", folder / "whole.npy", "--format", "Fx").stdout


def test_what_is_wrong_is_said_in_one_line():
    folder = FOLDER / "wrong"
    write_parts(folder, numpy.eye(4), [2])
    one_error_line(run("hull", exit_code=1), "usage")
    one_error_line(run("hull", folder / "whole.npy", "--points-sharded", "x", exit_code=1), "usage")
    one_error_line(run("hull", "--points-sharded", folder / "no-*.npy", exit_code=1), "file-missing")
    (folder / "part-02.txt").write_text("1 2 3\n")
    done = run("hull", "--points-sharded", folder / "part-*", exit_code=1)
    one_error_line(done, "wrong-count")
    assert "part-02.txt" in done.stderr and "part-00.npy" in done.stderr


def test_several_processes_without_the_module_are_an_error():
    alone = FOLDER / "alone"
    alone.mkdir()
    program = alone / "ndhull"
    shutil.copy(PROGRAM, program)
    done = subprocess.run([program, "hull", "--points-sharded", "part-*"], capture_output=True, check=False, text=True,
                          env={**os.environ, "OMPI_COMM_WORLD_SIZE": "2"})
    assert done.returncode == 1
    one_error_line(done, "usage")
    assert "has no MPI" in done.stderr


run_tests(globals())
