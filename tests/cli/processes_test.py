"""mpirun -n R ndhull hull --points-sharded: the bytes of one process with all points, whatever R is."""

import os
import pathlib
import shutil
import subprocess
import sys

import numpy

from program import PROGRAM, fresh_folder, run, run_tests

MODULE = pathlib.Path(PROGRAM).parent / "ndhull_mpi.so"
MPIRUN = shutil.which("mpirun")
FOLDER = fresh_folder("processes")
# Open MPI asks for these where tests run as root, and has fewer slots than processes where there are few cores.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1"}


def mpirun(processes, *arguments, exit_code=0):
    words = [MPIRUN, "-n", str(processes), PROGRAM, "hull", "--points-sharded", *map(str, arguments)]
    done = subprocess.run(words, capture_output=True, env=ENVIRONMENT, check=False, text=True, timeout=200)
    assert done.returncode == exit_code, (words, done.returncode, done.stdout[:500], done.stderr[:2000])
    return done


def write_parts(name, points, cuts):
    folder = FOLDER / name
    folder.mkdir()
    numpy.save(folder / "whole.npy", points)
    for number, (begin, end) in enumerate(zip([0, *cuts], [*cuts, len(points)])):
        numpy.save(folder / f"part-{number}.npy", points[begin:end])
    return folder


def expect_same_bytes(folder, *options):
    def outputs(name):
        return [folder / f"{name}.{file}" for file in ("npy", "txt")]

    def writing(name):
        planes, vertices = outputs(name)
        return ["--planes", planes, "--vertices", vertices, *options]

    run("hull", folder / "whole.npy", *writing("one"))
    expected = [file.read_bytes() for file in outputs("one")]
    for processes in (1, 2, 4):
        mpirun(processes, folder / "part-*.npy", *writing("several"))
        assert [file.read_bytes() for file in outputs("several")] == expected, (folder, processes, options)
        for file in outputs("several"):
            file.unlink()


def ndhull_lines(text):
    return [line for line in text.splitlines() if line.startswith("ndhull")]


def test_large_sets_that_are_reduced():
    points = numpy.random.default_rng(1).normal(size=(160_000, 5)).astype("float32")
    folder = write_parts("large", points, [20_000, 90_000, 90_001, 150_000])
    expect_same_bytes(folder)
    expect_same_bytes(folder, "--width", "5%")
    expect_same_bytes(folder, "--facets", "200", "--seed", "3")


def test_small_sets_and_more_processes_than_files():
    folder = write_parts("small", numpy.random.default_rng(2).normal(size=(500, 4)), [300])
    expect_same_bytes(folder)
    expect_same_bytes(folder, "--width", "10%", "--largest", "5", "--bounded")


def test_sets_of_which_nothing_can_be_dropped():
    points = numpy.random.default_rng(3).normal(size=(100_000, 4))
    points /= numpy.linalg.norm(points, axis=1, keepdims=True)
    expect_same_bytes(write_parts("sphere", points, [30_000, 70_000]), "--width", "5%")


def test_every_shard_is_verified():
    points = numpy.random.default_rng(4).normal(size=(120_000, 4))
    folder = write_parts("verified", points, [40_000, 80_000])
    mpirun(3, folder / "part-*.npy", "--width", "5%", "--verify", "--quiet")


def test_an_error_of_one_process_ends_all_with_one_line():
    folder = write_parts("wrong", numpy.random.default_rng(5).normal(size=(600, 3)), [200, 400])
    with (folder / "part-2.npy").open("r+b") as file:
        file.truncate(1000)
    done = mpirun(3, folder / "part-*.npy", exit_code=1)
    assert len(ndhull_lines(done.stderr)) == 1, done.stderr
    assert "part-2.npy" in ndhull_lines(done.stderr)[0]
    for options in (["--format", "n"], ["--planes", folder / "no" / "planes.npy"], ["--width", "x"]):
        (folder / "part-2.npy").unlink(missing_ok=True)
        done = mpirun(2, folder / "part-*.npy", *options, exit_code=1)
        assert ndhull_lines(done.stderr), (options, done.stderr)
    assert not list(folder.glob("*.planes"))


def test_a_process_that_is_killed_ends_the_others():
    points = numpy.random.default_rng(6).normal(size=(4000, 8))
    folder = write_parts("killed", points, [2000])
    words = [MPIRUN, "-n", "2", PROGRAM, "hull", "--points-sharded", folder / "part-*.npy", "--planes", folder / "p.npy",
             "--progress"]
    with subprocess.Popen(words, env=ENVIRONMENT, stderr=subprocess.PIPE, text=True) as running:
        try:
            # Not before they grow: of processes killed within MPI_Init one of seventy leaves mpirun waiting, even
            # where they do nothing else.
            assert any("growth" in line for line in running.stderr)
            found = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(running.pid)], capture_output=True,
                                   check=True, text=True).stdout.split("\n")
            children = [int(line.split()[0]) for line in found if line.endswith("ndhull")]
            os.kill(children[1], 9)
            running.communicate(timeout=60)
            assert running.returncode != 0
        finally:
            running.kill()
    assert not (folder / "p.npy").exists()


if not MODULE.exists():
    print("skipped: built without MPI")
    sys.exit(77)
assert MPIRUN, "ndhull was built with MPI, but there is no mpirun; install openmpi-bin"
run_tests(globals())
