# SPDX-License-Identifier: MIT OR Apache-2.0
"""Batches: subjects, resuming, failures, and a real scheduler with two workers over TCP, one killed."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
from api import meshes

import authalic
from authalic.io import FileError, MeshData, read_mesh, read_values, write_mesh

from .conftest import names, start

distributed = pytest.importorskip("distributed")
parquet = pytest.importorskip("pyarrow.parquet")

from authalic.batch import (  # noqa: E402
    SubjectsError,
    find_subjects,
    run_batch,
    schedule,
)
from authalic.batch import memory as memory_of_subjects  # noqa: E402
from authalic.batch.options import check_options  # noqa: E402
from authalic.batch.task import Task, run_task  # noqa: E402

ONLY_POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")


def bumps(seed, level=2):
    a, b, c = np.random.default_rng(seed).normal(size=3)
    return meshes.radial(lambda x, y, z: 1 + 0.3 * np.sin(3 * x + a) * np.cos(2 * y + b) + 0.1 * c * z, level)


def write_subjects(folder, count, level=2):
    folder.mkdir(exist_ok=True)
    for number in range(count):
        write_mesh(folder / f"s{number:02}.off", MeshData(*bumps(number, level)))
    return folder


def rows(out):
    return parquet.read_table(out / "figures.parquet").to_pylist()


def wait_for(condition, process=None):
    """Waits until a condition holds; fails after a minute, or if the process has ended."""
    ends = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < ends and (process is None or process.poll() is None)
        time.sleep(0.01)


def n_records(out):
    return len([path for path in (out / "records").rglob("*.json") if not path.name.startswith(".")])


@contextlib.contextmanager
def running(words, folder):
    process = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli." + words[0], *words[1:]],
        cwd=folder,
        stderr=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait(timeout=30)


@contextlib.contextmanager
def cluster(folder, *options, count=2):
    """A scheduler and workers, each in a process of its own, over TCP: address, workers, scheduler."""
    place = folder / "scheduler.json"
    words = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", place)
    with contextlib.ExitStack() as stack:
        scheduler = stack.enter_context(running(("dask_scheduler", *map(str, words)), folder))
        wait_for(place.exists, scheduler)
        words = ("dask_worker", "--scheduler-file", str(place), "--nthreads", "1", "--no-dashboard", *options)
        workers = [stack.enter_context(running(words, folder)) for _ in range(count)]
        address = json.loads(place.read_text(encoding="utf-8"))["address"]
        if count:
            with distributed.Client(address, set_as_default=False) as client:
                client.wait_for_workers(count, timeout=60)
        yield address, workers, scheduler


def test_every_subject_gets_the_librarys_map_and_one_row(run, folder):
    write_subjects(folder / "in", 3)
    result = run("batch", "sphere", "in", "--out", "out", "--workers", 2, "--areal", "--json")
    assert result.code == 0, result.err
    assert result.record["done"] == 3 and result.record["failed"] == []
    table = rows(folder / "out")
    assert [row["subject"] for row in table] == ["s00.off", "s01.off", "s02.off"]
    for number, row in enumerate(table):
        expected = authalic.sphere_map(*bumps(number))
        assert np.array_equal(read_mesh(row["output"]).vertices, expected.positions)
        assert row["area_ratio_std"] == expected.distortion.area_ratio_std and row["folded"] == 0
        assert row["outcome"] == "done" and row["status"] == expected.status and row["error_kind"] is None
        assert read_values(row["areal_distortion"]).shape == (66,)
    assert not [name for name in names(folder / "out") if ".authalic-" in name]


def test_a_batch_goes_on_where_it_was(run, folder):
    write_subjects(folder / "in", 2)
    words = ("batch", "sphere", "in", "--out", "out", "--workers", 1, "--json")
    assert run(*words).record["done"] == 2
    maps = folder / "out" / "maps"
    made = {path: path.stat().st_mtime_ns for path in maps.iterdir()}
    write_mesh(folder / "in" / "s02.off", MeshData(*bumps(2)))
    record = run(*words).record
    assert (record["done"], record["before"]) == (1, 2)
    assert all(path.stat().st_mtime_ns == time for path, time in made.items())
    assert len(rows(folder / "out")) == 3
    # another surface, another option, a map that is gone: all of them are to be done
    write_mesh(folder / "in" / "s00.off", MeshData(*bumps(7, level=3)))
    assert run(*words).record["done"] == 1
    (maps / "s01.sphere.off").unlink()
    assert run(*words).record["done"] == 1
    assert run(*words, "--angle-weight", 0.1).record["done"] == 3
    assert run(*words, "--angle-weight", 0.1).record["before"] == 3
    assert len(rows(folder / "out")) == 3


def test_what_is_wrong_with_a_surface_costs_only_its_subject(run, folder):
    write_subjects(folder / "in", 1)
    vertices, faces = meshes.octahedron()
    write_mesh(folder / "in" / "bad.off", MeshData(vertices, np.vstack([faces, faces[2:3]])))
    (folder / "in" / "torn.off").write_text("OFF 9 9")
    result = run("batch", "sphere", "in", "--out", "out", "--workers", 1)
    assert result.code == 8 and "failed: bad.off: duplicate_face" in result.err
    table = {row["subject"]: row for row in rows(folder / "out")}
    assert len(table) == 3 and table["s00.off"]["outcome"] == "done"
    bad, torn = table["bad.off"], table["torn.off"]
    assert (bad["outcome"], bad["error_kind"], bad["error_indices"], bad["error_count"]) == (
        *("failed", "duplicate_face", "[8]", 1),
    )
    assert bad["attempts"] == 1 and torn["error_kind"] == "FileError"
    # mended, it is done by the next run
    write_mesh(folder / "in" / "bad.off", MeshData(vertices, faces))
    result = run("batch", "sphere", "in", "--out", "out", "--workers", 1, "--json")
    assert result.code == 8 and result.record["done"] == 1 and result.record["before"] == 1


def test_disks_and_unwraps_are_batches_too(run, folder):
    (folder / "in").mkdir()
    write_mesh(folder / "in" / "cap.ply", MeshData(*meshes.bumpy_cap()))
    words = ("in", "--out", "out", "--workers", 1, "--json")
    assert run("batch", "disk", *words, "--boundary", "free", "--angle-weight", 0.1).record["done"] == 1
    assert run("batch", "unwrap", *words, "--output-format", "npz").record["done"] == 1
    assert [name for name in names(folder / "out") if "maps" in name] == [
        *("maps/cap.disk.obj", "maps/cap.unwrap.npz"),
    ]
    assert read_mesh(folder / "out" / "maps" / "cap.disk.obj").uv is not None


@ONLY_POSIX
def test_a_worker_that_is_killed_costs_no_subject(folder):
    """A real scheduler and two workers over TCP; one of them is killed between two subjects or in one."""
    write_subjects(folder / "in", 14, level=5)
    out = folder / "out"
    with cluster(folder, "--no-nanny") as (address, workers, _):
        command = [sys.executable, "-m", "authalic", "batch", "sphere", "in", "--out", "out"]
        batch = subprocess.Popen(
            [*command, "--scheduler", address], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        wait_for(lambda: len({_worker(path) for path in (out / "records").glob("s*.json")}) == 2, batch)
        workers[0].kill()
        said = batch.communicate(timeout=120)
    assert batch.returncode == 0, said
    table = rows(out)
    assert [row["subject"] for row in table] == [f"s{number:02}.off" for number in range(14)]
    assert {row["outcome"] for row in table} == {"done"} and len({row["worker"] for row in table}) == 2
    for number in (0, 13):
        expected = authalic.sphere_map(*bumps(number, 5)).positions
        assert np.array_equal(read_mesh(out / "maps" / f"s{number:02}.sphere.off").vertices, expected)


@ONLY_POSIX
def test_a_batch_whose_scheduler_is_killed_says_so_and_goes_on_elsewhere(folder):
    write_subjects(folder / "in", 8, 5)
    command = [sys.executable, "-m", "authalic", "batch", "sphere", "in", "--out", "out"]
    with cluster(folder) as (address, _, scheduler):
        batch = subprocess.Popen([*command, "--scheduler", address], cwd=folder, stderr=subprocess.PIPE)
        wait_for(lambda: n_records(folder / "out") > 0, batch)
        scheduler.kill()
        said = batch.communicate(timeout=120)[1].decode()
    assert batch.returncode == 7 and "the connection to the scheduler was lost" in said
    assert "Traceback" not in said and "distributed" not in said
    done = subprocess.run(
        [*command, "--workers", "1", "--json"], cwd=folder, capture_output=True, timeout=120
    )
    summary = json.loads(done.stdout)
    assert summary["before"] > 0 and summary["before"] + summary["done"] == 8
    assert [row["outcome"] for row in rows(folder / "out")] == ["done"] * 8


def _worker(path):
    return json.loads(path.read_text(encoding="utf-8"))["worker"]


TROUBLE = """
import os, signal
from pathlib import Path
from authalic.batch import task
from authalic.runs.sphere import sphere_run

def troubled(source, target, **arguments):
    if source.name == "killer.off":
        os.kill(os.getpid(), signal.SIGKILL)
    if source.name == "shaky.off" and not Path("shaken").exists():
        Path("shaken").touch()
        raise RuntimeError("the first time")
    if source.name == "hopeless.off":
        raise RuntimeError("every time")
    return sphere_run(source, target, **arguments)

task.RUNS["sphere"] = troubled
"""


@ONLY_POSIX
def test_a_subject_that_kills_its_workers_is_reported_and_the_others_are_done(run, folder):
    write_subjects(folder / "in", 6)
    for name in ("killer", "shaky", "hopeless"):
        write_mesh(folder / "in" / f"{name}.off", MeshData(*bumps(9)))
    (folder / "trouble.py").write_text(TROUBLE)
    with cluster(folder, "--preload", "trouble.py") as (address, *_):
        words = ("in", "--out", "out", "--scheduler", address, "--retries", 1)
        result = run("batch", "sphere", *words)
    assert result.code == 8, result.err
    table = {row["subject"]: row for row in rows(folder / "out")}
    assert len(table) == 9
    failed = {name: row["error_kind"] for name, row in table.items() if row["outcome"] == "failed"}
    assert failed == {"killer.off": "worker_lost", "hopeless.off": "RuntimeError"}
    assert table["shaky.off"]["attempts"] == 2 and table["hopeless.off"]["error_message"] == "every time"


BATCH = "import sys; from authalic.cli import main\nif __name__ == '__main__': sys.exit(main({words}))"


@ONLY_POSIX
@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGKILL", -9)])
def test_a_batch_that_is_stopped_goes_on_when_it_is_run_again(name, code, folder):
    write_subjects(folder / "in", 8, level=5)
    words = ["batch", "sphere", "in", "--out", "out", "--workers", "1"]
    out = folder / "out"
    batch = start(BATCH.format(words=words), folder, start_new_session=True)
    wait_for(lambda: n_records(out) >= 2, batch)
    if name == "SIGINT":
        os.killpg(batch.pid, signal.SIGINT)  # as a terminal does it: to the workers too
    else:
        batch.send_signal(getattr(signal, name))
    _, said = batch.communicate(timeout=60)
    assert batch.returncode == code, said
    assert b"Traceback" not in said
    if name != "SIGKILL":
        assert 2 <= len(rows(out)) < 8
        assert not [name for name in names(out) if ".authalic-" in name]
    again = start(BATCH.format(words=[*words, "--json"]), folder)
    said = again.communicate(timeout=120)
    record = json.loads(said[0])
    assert again.returncode == 0 and record["before"] >= 2 and record["before"] + record["done"] == 8
    assert [row["subject"] for row in rows(out)] == [f"s{number:02}.off" for number in range(8)]
    assert not [name for name in names(out) if ".authalic-" in name]


def test_a_subject_too_large_for_every_worker_is_refused(run, folder, monkeypatch):
    write_subjects(folder / "in", 2)
    large = folder / "in" / "s01.off"
    monkeypatch.setattr(memory_of_subjects, "PROCESS", 0)
    monkeypatch.setattr(memory_of_subjects, "PER_VERTEX", 800_000_000 * 80 // large.stat().st_size)
    write_mesh(folder / "in" / "s00.off", MeshData(*meshes.octahedron()))
    result = run("batch", "sphere", "in", "--out", "out", "--workers", 1, "--memory", "600MB")
    assert result.code == 8 and "it needs about 0.8 GB, but no worker has more than 0.6 GB" in result.err
    assert {row["subject"]: row["error_kind"] for row in rows(folder / "out")} == {
        **{"s00.off": None, "s01.off": "memory"},
    }


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("sphere", ("--angle-weight", "-1")),
        ("disk", ("--boundary", "rectangle", "--aspect", "-2")),
        ("unwrap", ("--target", "0.5")),
    ],
)
def test_options_that_are_wrong_for_all_are_refused_before_work_starts(command, words, run, folder):
    result = run("batch", command, "ball.obj", "cap.obj", "--out", "out", *words)
    assert result.code == 2 and words[-2].strip("-").replace("-", "_") in result.err
    assert not (folder / "out").exists()
    with pytest.raises(TypeError, match="nonsense"):
        run_batch(find_subjects([folder / "ball.obj"]), folder / "out", command, options={"nonsense": 1})


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("sphere", {"method": "fixed_point"}),
        ("sphere", {"fill_holes": True, "repair": True, "area_tolerance": 0.01}),
        ("disk", {"boundary": "rectangle", "aspect": 2.0}),
        ("disk", {"boundary": "free", "overlap": True, "angle_weight": 0.1}),
        ("unwrap", {"target": 1.25, "pack": False, "max_islands": 1}),
    ],
)
def test_good_options_are_not_refused(command, options):
    check_options(command, options)


@pytest.mark.skipif(sys.platform != "linux", reason="the peak is read from /proc")
def test_the_estimate_of_memory_covers_what_a_map_takes(folder):
    """The peak of a process that maps 16,386 vertices, against the estimate from the file's size."""
    for name in ("ball.off", "ball.npz", "lh.ball"):
        write_mesh(folder / name, MeshData(*meshes.bumpy_ball(6)))
    code = """
import re
import authalic.io
def peak():
    return 1024 * int(re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())[1])
mesh = authalic.io.read_mesh("ball.off")
before = peak()
authalic.sphere_map(mesh.vertices, mesh.faces)
print(peak() - before)
"""
    process = start(code, folder)
    needed = int(process.communicate(timeout=120)[0])
    for name in ("ball.off", "ball.npz", "lh.ball"):
        estimate = memory_of_subjects.estimate(folder / name, None) - memory_of_subjects.PROCESS
        assert 0.5 * needed < estimate < 3 * needed, name


def test_a_scheduler_that_is_not_there_is_an_error_of_its_own(run, folder, monkeypatch):
    from authalic.batch import cluster

    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.5)
    result = run("batch", "sphere", "ball.obj", "--out", "out", "--scheduler", "tcp://127.0.0.1:1")
    assert result.code == 7 and "cannot be reached" in result.err


@ONLY_POSIX
def test_a_scheduler_without_workers_is_an_error_of_its_own(run, folder, monkeypatch):
    monkeypatch.setattr(schedule, "PATIENCE", 0.5)
    with cluster(folder, count=0) as (address, *_):
        result = run("batch", "sphere", "ball.obj", "--out", "out", "--scheduler", address)
    assert result.code == 7 and "there was no worker" in result.err


def test_subjects_come_from_folders_files_and_tables(folder):
    (folder / "study" / "sub-1" / "surf").mkdir(parents=True)
    (folder / "study" / "sub-2" / "surf").mkdir(parents=True)
    for subject in ("sub-1", "sub-2"):
        for name in ("lh.white", "lh.pial", "lh.sulc", ".authalic-1-lh.white"):
            (folder / "study" / subject / "surf" / name).touch()

    def found(*places, **options):
        return [subject.name for subject in find_subjects(places, **options)]

    assert found(folder / "study") == ["sub-1/surf/lh.white", "sub-2/surf/lh.white"]
    assert found(folder / "study", pattern="*.pial") == ["sub-1/surf/lh.pial", "sub-2/surf/lh.pial"]
    assert found(folder / "ball.obj", folder / "cap.obj", folder / "ball.obj") == ["ball.obj", "cap.obj"]
    (folder / "table.csv").write_text("subject,age,surface\nfirst,7,ball.obj\nsecond/left,8,study/x.obj\n")
    subjects = find_subjects([folder / "table.csv"])
    assert [subject.name for subject in subjects] == ["first", "second/left"]
    assert subjects[0].surface == folder / "ball.obj" and subjects[1].surface == folder / "study" / "x.obj"


def test_subjects_of_a_table_have_folders_of_their_own(run, folder):
    """Their surfaces have the same names."""
    for number, subject in enumerate(("sub-01", "sub-02")):
        (folder / subject).mkdir()
        write_mesh(folder / subject / "lh.white", MeshData(*bumps(number)))
    rows_of_table = "subject,surface\nsub-01,sub-01/lh.white\nsub-02,sub-02/lh.white\n"
    (folder / "table.csv").write_text(rows_of_table)
    result = run("batch", "sphere", "table.csv", "--out", "out", "--areal", "--workers", 1)
    assert result.code == 0, result.err
    for number, subject in enumerate(("sub-01", "sub-02")):
        sphere = read_mesh(folder / "out" / "maps" / subject / "lh.authalic.sphere").vertices / 100
        assert np.allclose(sphere, authalic.sphere_map(*bumps(number)).positions, atol=1e-3)
        assert (folder / "out" / "maps" / subject / "lh.authalic.areal").exists()


@pytest.mark.parametrize("name", ["sphere", "disk", "unwrap"])
def test_batches_take_the_options_of_their_commands(name):
    from authalic.cli.app import authalic as command

    own, of_batch = (
        {option for parameter in place.commands[name].params for option in parameter.opts if "--" in option}
        for place in (command, command.commands["batch"])
    )
    assert own - of_batch <= {"--radius"} and len(own) > 8


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are text")
def test_names_of_files_need_be_no_text(folder):
    name = os.fsdecode(b"sub-\xff.obj")
    write_mesh(folder / name, MeshData(*meshes.octahedron()))
    words = [sys.executable, "-m", "authalic", "batch", "sphere", name, "--out", "out", "--workers", "1"]
    done = subprocess.run(words, cwd=folder, capture_output=True, timeout=100)
    assert done.returncode == 0, done.stderr
    [row] = rows(folder / "out")
    assert (row["subject"], row["outcome"]) == ("sub-\\udcff.obj", "done")
    assert (folder / "out" / "maps" / os.fsdecode(b"sub-\xff.sphere.obj")).exists()


def test_maps_of_a_batch_are_no_subjects(run, folder):
    """The batch's folder may lie among the surfaces."""
    write_subjects(folder / "study", 2)
    for before in (0, 2):
        words = ("batch", "sphere", "study", "--out", "study/derived/spheres", "--workers", 1, "--json")
        record = run(*words).record
        assert (record["subjects"], record["before"], record["failed"]) == (2, before, [])
    named = find_subjects([folder / "study" / "derived" / "spheres" / "maps"])
    assert [subject.name for subject in named] == ["s00.sphere.off", "s01.sphere.off"]
    patterned = find_subjects([folder / "study"], pattern="study/*.off")
    assert [subject.name for subject in patterned] == ["s00.off", "s01.off"]


@pytest.mark.parametrize(
    ("table", "error", "said"),
    [
        ("name,surface\na,ball.obj\n", FileError, "lacks the columns subject"),
        ("subject,surface\na,\n", FileError, "line 2 has no"),
        ("subject,surface\n../a,ball.obj\n", FileError, "without"),
        ("subject,surface\na,ball.obj\na,cap.obj\n", SubjectsError, "two subjects are named a"),
        ("subject,surface\n", SubjectsError, "there are no surfaces"),
    ],
)
def test_a_table_that_says_nothing_clear_is_refused(table, error, said, folder):
    (folder / "table.csv").write_text(table)
    with pytest.raises(error, match=said):
        find_subjects([folder / "table.csv"])


def test_two_subjects_for_one_file_are_refused_before_work_starts(folder):
    for name in ("lh.white", "lh.pial"):
        write_mesh(folder / name, MeshData(*meshes.octahedron()))
    with pytest.raises(SubjectsError, match=r"lh.pial and lh.white would both be written to"):
        run_batch(find_subjects([folder / "lh.white", folder / "lh.pial"]), folder / "out")
    assert not (folder / "out").exists()


class LosingClient:
    """A client whose workers are lost with the first task that each of them gets."""

    status = "running"

    def __init__(self, workers, writes_record):
        self.workers, self.writes_record = workers, writes_record
        self.sent = []

    def scheduler_info(self, n_workers):
        there = self.workers[len(self.sent) :]
        return {"workers": {address: {"memory_limit": 0} for address in there[:1]}}

    def submit(self, function, task, *, key, workers, pure):
        self.sent.append((task.subject, task.attempt, *workers))
        if self.writes_record:
            function(task)
        return Unanswered()

    def cancel(self, futures, force):
        pass


class Unanswered:
    """A future that never ends."""

    def add_done_callback(self, function):
        pass

    def done(self):
        return False


def lost_task(folder):
    return Task(
        "ball", str(folder / "ball.obj"), str(folder / "ball.out.obj"), str(folder), "sphere", threads=0
    )


def test_a_task_moves_to_another_worker_until_it_was_tried_often_enough(folder, monkeypatch):
    monkeypatch.setattr(schedule, "LOOK", 0.01)
    client, records = LosingClient(["a", "b", "c", "d"], writes_record=False), []
    schedule.Schedule(client, [lost_task(folder)], 2, records.append).run()
    assert client.sent == [("ball", 1, "a"), ("ball", 2, "b"), ("ball", 3, "c")]
    assert [record["error"]["kind"] for record in records] == ["worker_lost"]
    assert "3 workers were lost" in records[0]["error"]["message"]


def test_a_record_that_was_written_before_its_worker_was_lost_is_collected(folder, monkeypatch):
    monkeypatch.setattr(schedule, "LOOK", 0.01)
    client, records = LosingClient(["a", "b"], writes_record=True), []
    schedule.Schedule(client, [lost_task(folder)], 2, records.append).run()
    assert client.sent == [("ball", 1, "a")] and [record["outcome"] for record in records] == ["done"]


def test_a_worker_of_another_version_makes_no_map(folder):
    record = run_task(replace(lost_task(folder), version="0.0.7"))
    assert record["outcome"] == "failed" and record["error"]["kind"] == "VersionError"
    assert "but the batch 0.0.7" in record["error"]["message"] and not (folder / "ball.out.obj").exists()
