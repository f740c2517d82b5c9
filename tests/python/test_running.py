"""Threads, Ctrl-C, progress, memory, pickling."""

import copy
import ctypes
import gc
import os
import pickle
import signal
import sys
import threading
import time

import numpy as np
import pytest

import pirsim


@pytest.fixture(scope="module")
def model(room, study_a):
    return pirsim.compile(room, study_a, set={"replicates": 2})


def test_two_threads_run_two_models_at_once(room, study_a, data):
    models = [pirsim.compile(room, study_a, set={"replicates": 2}),
              pirsim.compile(data / "rooms" / "open_office.gltf", data / "studies" / "office.yaml",
                             set={"replicates": 4})]
    alone = [pirsim.run(model) for model in models]
    both_run = threading.Barrier(2, timeout=60)  # is broken if one is never told while the other one runs
    results = [None, None]

    def work(i):
        met = []

        def progress(done, of):
            if not met and done < of:
                met.append(both_run.wait())

        results[i] = pirsim.run(models[i], threads=1, progress=progress)
        assert met

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for together, before in zip(results, alone):
        assert np.array_equal(together.bits, before.bits) and np.array_equal(together.people, before.people)


def test_threads_share_a_model(model):
    expected = pirsim.run(model).bits
    results = []
    threads = [threading.Thread(target=lambda: results.append(pirsim.run(model, threads=2).bits)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4 and all(np.array_equal(bits, expected) for bits in results)


@pytest.fixture
def interruptible():
    """Also where a shell began the tests in the background, with Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize("work", ["run", "trace", "coverage", "walk_test"])
def test_ctrl_c_ends_long_work(work, room, study_a, data):
    model = pirsim.compile(room, study_a, set={"replicates": 100_000})
    calls = {
        "run": lambda: pirsim.run(model),
        "trace": lambda: pirsim.trace(model),
        "coverage": lambda: pirsim.coverage(room, data / "studies" / "studyB.yaml", set={"spacing_m": 0.005}),
        "walk_test": lambda: pirsim.walk_test(room, data / "studies" / "walk_test.yaml", set={"spacing_m": 0.05}),
    }
    pressed = []

    def press():
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.7, press)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            calls[work]()
    finally:
        timer.cancel()
    assert time.monotonic() - pressed[0] < 20  # a row of the walk test's points is the longest step
    assert pirsim.run(model, [0]).valid.any()  # nothing is left of it


def test_progress_is_told_and_may_end_the_work(model, room, study_a):
    told = []
    pirsim.run(model, progress=lambda done, of: told.append((done, of)))
    assert told[-1] == (20, 20) and told == sorted(told)

    class Enough(Exception):
        pass

    def stop(done, of):
        raise Enough

    many = pirsim.compile(room, study_a, set={"replicates": 100_000})
    with pytest.raises(Enough):
        pirsim.run(many, progress=stop)


class Mallinfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks",
                                                     "fsmblks", "uordblks", "fordblks", "keepcost")]


def bytes_in_use():
    """What malloc has given out, and Python's own blocks: exact, unlike the process's resident memory."""
    gc.collect()
    mallinfo = ctypes.CDLL(None).mallinfo2
    mallinfo.restype = Mallinfo
    info = mallinfo()
    return info.uordblks + info.hblkhd, sys.getallocatedblocks()


def growth(model, n, keep):
    """Of bytes and of Python's blocks over n results, after as many to warm up."""
    kept = []
    for _ in range(n):
        pirsim.run(model, [0], threads=1)
    bytes_in_use()  # which keeps something of its own at its first call
    before = bytes_in_use()
    for _ in range(n):
        result = pirsim.run(model, [0], threads=1)
        if keep:
            kept.append(result)
    del result
    return [after - b for after, b in zip(bytes_in_use(), before)]


@pytest.mark.slow
def test_many_results_take_no_memory(room, study_a):
    model = pirsim.compile(room, study_a, set={"people.0.actions.3.work.duration_s": 5, "replicates": 1})
    n = 200
    result = pirsim.run(model, [0])
    held = result.bits.nbytes + result.people.nbytes + result.phase_code.nbytes + result.valid.nbytes
    growth(model, n, keep=False)  # the interpreter keeps up to a hundred blocks of its own as it runs this first
    grown, blocks = growth(model, n, keep=False)
    assert grown < 0.05 * n * held and blocks < 0.5 * n
    grown, blocks = growth(model, n, keep=True)  # the twin that must show a leak
    assert grown > 0.8 * n * held and blocks > 2 * n


def test_a_result_outlives_its_model(room, study_a):
    model = pirsim.compile(room, study_a, set={"replicates": 1})
    result = pirsim.run(model)
    bits, copied = result.bits, result.bits.copy()
    view = result.bits[3, :, 2]
    del model, result
    gc.collect()
    pirsim.run(pirsim.compile(room, study_a, set={"replicates": 1, "seed": 5}))  # takes memory that was given back
    assert np.array_equal(bits, copied) and np.array_equal(view, copied[3, :, 2])
    assert bits.base is not None  # a view of what the library wrote, not a copy


def test_pickling_is_refused_with_a_reason_where_it_can_not_work(model, room, study_a):
    for thing in (model, pirsim.trace(model, [0])):
        for attempt in (pickle.dumps, copy.deepcopy):
            with pytest.raises(TypeError, match="can't be pickled: pickle its scene and script"):
                attempt(thing)
    scene, script = pickle.loads(pickle.dumps((pirsim.read_scene(room), pirsim.read_script(study_a))))
    script.replicates = 2
    result = pirsim.run(pirsim.compile(scene, script))
    again = pickle.loads(pickle.dumps(result))
    assert np.array_equal(again.bits, pirsim.run(model).bits) and again.sensors == result.sensors
    with pytest.raises(TypeError, match=r"expected a pirsim\.Model, which pirsim\.compile.* not a str"):
        pirsim.run("room.gltf")
    with pytest.raises(TypeError, match="compile"):
        pirsim.Model()


def test_runs_that_are_not_there_take_no_memory(model):
    """A range of 10^12 was made a list, of 7.6 GB when it was killed; 1.9 became 1."""
    import itertools
    import resource

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for runs, error in ((range(10**12), IndexError), (range(-10**12, 0), IndexError), (itertools.count(), IndexError),
                        (itertools.repeat(0), ValueError), (10**12, IndexError), ([0, 1.9], TypeError),
                        (1.9, TypeError), ("1", TypeError), (np.array([0.5]), TypeError)):
        for work in (pirsim.run, pirsim.trace):
            with pytest.raises(error, match="run"):
                work(model, runs)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # kB
    assert pirsim.run(model, np.array([3, 1])).run.tolist() == [3, 1]


def test_numbers_that_size_things_are_refused_by_name(model, room, study_a, data):
    script = data / "studies" / "studyB.yaml"
    for call, error, message in (
            (lambda: pirsim.run(model, 0, threads=-1), ValueError, "threads"),
            (lambda: pirsim.run(model, 0, threads=10**12), ValueError, "threads"),
            (lambda: pirsim.run(model, 0, threads=1.5), TypeError, "threads"),
            (lambda: pirsim.coverage(room, script, threads=-1), ValueError, "threads"),
            (lambda: pirsim.trace(model, 0).emit(seed=-1), ValueError, "seed"),
            (lambda: pirsim.trace(model, 0).emit(seed=2**63), ValueError, "seed"),
            (lambda: pirsim.room(data / "recipes" / "tiny.yaml", 1.5), TypeError, "number"),
            (lambda: pirsim.reconcile(room, study_a, "rows.csv", max_effects=10**12), ValueError, "max_effects"),
            (lambda: pirsim.reconcile(room, study_a, "rows.csv", seed=-1), ValueError, "seed")):
        with pytest.raises(error, match=message):
            call()


def test_a_path_is_not_cut_off_at_a_nul(model, room, study_a, data, tmp_path):
    for call in (lambda: pirsim.compile(f"{room}\0.gltf", study_a), lambda: pirsim.compile(room, f"{study_a}\0"),
                 lambda: pirsim.read_scene(f"{room}\0"), lambda: pirsim.sensor_model("EKMC1604111\0"),
                 lambda: pirsim.read_scene(room, sensors=["a\0b"]),
                 lambda: pirsim.write_scene(pirsim.read_scene(room), f"{tmp_path}/a.gltf\0b"),
                 lambda: pirsim.dataset(data / "recipes" / "tiny.yaml", f"{tmp_path}/a\0b")):
        with pytest.raises(ValueError, match="NUL"):
            call()
    assert not list(tmp_path.iterdir())


def test_results_print_in_a_few_lines(model):
    result = pirsim.run(model, range(3), zones=True, occupants=True)
    text = repr(result)
    assert text.count("\n") < 8 and len(text) < 800
    for told in ("3 runs", "3 trials (S1, S2, S3)", f"seed {model.seed}", "PIR5", "0 faults", "zones of 3 runs"):
        assert told in text
    assert result.seed == model.seed == model.script.seed
    assert pirsim.trace(model, 0).emit(seed=7).seed == 7
    for thing in (model, model.sensors, model.seats, model.rays, pirsim.trace(model, 0)):
        assert repr(thing).startswith("<pirsim.") and len(repr(thing)) < 200


def test_every_array_owns_its_memory(model):
    """Which the page and the class said in two ways that can't both be true."""
    result = pirsim.run(model, 0)
    arrays = [result.bits, result.people, result.valid, result.time, result.phase_code, result.run]
    for i, array in enumerate(arrays):
        assert not array.flags.writeable
        assert not any(np.shares_memory(array, other) for other in arrays[:i])


def test_arguments_are_refused_by_name(model, room, study_a):
    with pytest.raises(IndexError, match="run 20: the study has runs 0 to 19"):
        pirsim.run(model, range(15, 21))
    with pytest.raises(IndexError, match="run -1"):
        pirsim.run(model, -1)
    with pytest.raises(KeyError, match="no trial 'S11'"):
        model.runs_of("S11")
    with pytest.raises(TypeError, match="set"):
        pirsim.compile(room, study_a, set="seed=1")
    with pytest.raises(TypeError, match="change the pirsim.Script itself"):
        pirsim.compile(room, pirsim.read_script(study_a), set={"seed": 1})
    with pytest.raises(TypeError, match="pirsim.Scene"):
        pirsim.compile(3, study_a)
