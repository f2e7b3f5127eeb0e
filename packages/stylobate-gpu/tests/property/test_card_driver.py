"""The graphics card by its driver's interface, with a driver that is made here: what it is asked, what refusals say."""

import ctypes
import sys
import threading
import types
from enum import IntEnum

import numpy as np
import pytest

import stylobate as st
from stylobate.kernels.run_codes import ENDED, RUNNING
from stylobate_gpu import card, driver, kinds


class Code(IntEnum):
    """What the driver answers."""

    CUDA_SUCCESS = 0
    CUDA_ERROR_INVALID_PTX = 218
    CUDA_ERROR_LAUNCH_FAILED = 719


class Driver(types.SimpleNamespace):
    """A driver of one card, whose memory is that of this process."""

    def __init__(self, cards=1, capability=(9, 0), load=Code.CUDA_SUCCESS, launch=Code.CUDA_SUCCESS):
        numbers = {
            "MAJOR": capability[0],
            "MINOR": capability[1],
            "SHARED": 232448,
            "DYNAMIC": "dynamic",
            "THREADS": 384,
            "PROCESSORS": 132,
        }
        self.CUdevice_attribute = types.SimpleNamespace(
            CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR="MAJOR",
            CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR="MINOR",
            CU_DEVICE_ATTRIBUTE_MAX_SHARED_MEMORY_PER_BLOCK_OPTIN="SHARED",
            CU_DEVICE_ATTRIBUTE_MULTIPROCESSOR_COUNT="PROCESSORS",
        )
        self.CUfunction_attribute = types.SimpleNamespace(
            CU_FUNC_ATTRIBUTE_MAX_DYNAMIC_SHARED_SIZE_BYTES="DYNAMIC",
            CU_FUNC_ATTRIBUTE_MAX_THREADS_PER_BLOCK="THREADS",
            CU_FUNC_ATTRIBUTE_PREFERRED_SHARED_MEMORY_CARVEOUT="CARVEOUT",
        )
        self.CUshared_carveout = types.SimpleNamespace(CU_SHAREDMEM_CARVEOUT_MAX_SHARED=100)
        ok = Code.CUDA_SUCCESS
        self.memory, self.current, self.launched, self.ended, self.set, self.asked = {}, {}, [], [], {}, []
        self.cuInit = lambda flags: (ok,)
        self.cuDeviceGetCount = lambda: (ok, cards)
        self.cuDeviceGet = lambda number: (ok, number)
        self.cuDeviceGetAttribute = lambda which, device: (ok, numbers[which])
        self.cuDeviceGetName = lambda length, device: (ok, b"NVIDIA H100".ljust(length, b"\0"))
        self.cuDriverGetVersion = lambda: (ok, 13000)
        self.cuDevicePrimaryCtxRetain = lambda device: (ok, "context")
        self.cuModuleLoadData = lambda text: (load, text)
        self.cuModuleGetFunction = lambda module, name: (ok, (module, name))
        self.cuFuncSetAttribute = lambda function, which, value: (self.set.update({which: value}), (ok,))[1]
        self.cuFuncGetAttribute = lambda which, function: (ok, numbers[which])
        self.cuOccupancyMaxActiveBlocksPerMultiprocessor = lambda *given: (self.asked.append(given), (ok, 3))[1]
        self.cuLaunchKernel = lambda *given: (self.launched.append(given), (launch,))[1]
        self.CUstream_flags = types.SimpleNamespace(CU_STREAM_NON_BLOCKING=1)
        self.cuStreamCreate = lambda flags: (ok, "queue")
        self.cuStreamSynchronize = lambda queue: (ok,)
        self.cuStreamDestroy = lambda queue: (self.ended.append(queue), (ok,))[1]

    def cuCtxSetCurrent(self, context):
        self.current[threading.get_ident()] = context
        return (Code.CUDA_SUCCESS,)

    def cuMemAlloc(self, size):
        assert self.current[threading.get_ident()] == "context"
        made = np.zeros(size, np.uint8)
        self.memory[made.ctypes.data] = made
        return Code.CUDA_SUCCESS, made.ctypes.data

    def cuMemFree(self, address):
        del self.memory[address]
        return (Code.CUDA_SUCCESS,)

    def cuMemcpyHtoDAsync(self, there, here, size, queue):
        assert queue == "queue"
        ctypes.memmove(there, here, size)
        return (Code.CUDA_SUCCESS,)

    def cuMemcpyDtoHAsync(self, here, there, size, queue):
        assert queue == "queue"
        ctypes.memmove(here, there, size)
        return (Code.CUDA_SUCCESS,)


@pytest.fixture
def drive(monkeypatch, tmp_path):
    """Puts a driver in place of that of this machine, and a kernel for it."""
    monkeypatch.setattr(kinds, "FOLDER", tmp_path)
    (tmp_path / "rim.ptx").write_text(f"{kinds.stamp()}\n.version 9.0\n")

    def put(**how):
        made = Driver(**how)
        monkeypatch.setitem(sys.modules, "cuda", types.ModuleType("cuda"))
        bindings = types.ModuleType("cuda.bindings")
        bindings.driver = made
        monkeypatch.setitem(sys.modules, "cuda.bindings", bindings)
        return made

    return put


def test_the_card_tells_its_name(drive):
    drive()
    device = driver.Card()
    assert device.name == "NVIDIA H100, sm_90, CUDA 13.0"
    assert device.shared == 232448


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"cards": 0}, "no NVIDIA card is found"),
        ({"capability": (7, 5)}, "NVIDIA H100 has compute capability 7.5; allowed is 8.0 or newer"),
    ],
)
def test_a_card_that_cannot_be_used_is_refused(drive, how, words):
    drive(**how)
    with pytest.raises(st.InputError, match=words):
        driver.Card()


def test_a_driver_that_is_not_there_is_said(drive):
    def absent(flags):
        raise RuntimeError("libcuda.so.1 is not found")

    drive().cuInit = absent
    with pytest.raises(
        st.InputError, match=r"the driver of NVIDIA cards does not answer \(libcuda.so.1 is not found\)"
    ):
        driver.Card()


def test_a_driver_too_old_for_a_kernel_is_said(drive):
    drive(load=Code.CUDA_ERROR_INVALID_PTX)
    with pytest.raises(st.InputError, match=r"does not take the kernel 'rim' .*CUDA_ERROR_INVALID_PTX.*a newer driver"):
        driver.Card().kernel("rim", 1000)


def test_a_launch_that_fails_is_no_result(drive):
    drive(launch=Code.CUDA_ERROR_LAUNCH_FAILED)
    records = card.CardRecords(driver.Card(), "rim", 3, 2)
    with pytest.raises(st.StylobateError, match="the graphics card has failed: CUDA_ERROR_LAUNCH_FAILED"):
        records.advance(10)


def test_records_are_brought_before_a_launch_and_fetched_once_a_run_has_ended(drive):
    made = drive()
    records = card.CardRecords(driver.Card(), "rim", 3, 5)
    random = np.random.default_rng(1)
    for array in records.here.values():
        array.view(np.uint8)[...] = random.integers(0, 255, array.view(np.uint8).shape)
    records.here["watch"]["status"] = RUNNING
    before = {name: array.copy() for name, array in records.here.items()}

    def on_card(name):
        memory = made.memory[records.there[name]]
        return memory.view(before[name].dtype).reshape(before[name].shape)

    records.advance(10)
    assert all(on_card(name).tobytes() == before[name].tobytes() for name in before)
    on_card("site")["body"]["x"] += 1.0
    records.advance(10)
    assert records.here["site"].tobytes() == before["site"].tobytes(), "no run has ended"
    made.cuLaunchKernel = lambda *_: (on_card("watch")["status"].__setitem__((2, 1), ENDED), (Code.CUDA_SUCCESS,))[1]
    records.advance(10)
    assert records.here["watch"]["status"][2, 1] == ENDED
    assert records.here["site"].tobytes() == on_card("site").tobytes() != before["site"].tobytes()


def test_views_are_of_the_numbers_of_every_lane(drive):
    drive()
    records = card.CardRecords(driver.Card(), "rim", 3, 5)
    records.here["site"]["body"]["x"][4, 2, 1] = 7.0
    records.here["site"]["joint"]["mu"][4, 2, 1] = 8.0
    records.here["watch"]["when"][4, 1] = 9
    views = records.views()
    names = {name: kinds.kinds()["rim"][name] for name in views}
    first = {
        name: [field[1] // 8 // kinds.BLOCK_LANES for field in dtype.fields.values()] for name, dtype in names.items()
    }
    place = {name: dict(zip(dtype.names, first[name], strict=True)) for name, dtype in names.items()}
    assert views["body"].shape[0] == 4
    assert views["joint"].shape[0] == 3
    assert views["body"][2, place["body"]["x"], 4, 1].view(float) == 7.0
    assert views["joint"][2, place["joint"]["mu"], 4, 1].view(float) == 8.0
    assert views["watch"][0, place["watch"]["when"], 4, 1] == 9


def test_a_launch_is_told_every_array_as_compiled_code_takes_it(drive):
    made = drive()
    records = card.CardRecords(driver.Card(), "rim", 3, 5)
    records.advance(7)
    (function, blocks, _, _, threads, _, _, shared, stream, (values, kinds_of), extra), *_ = made.launched
    assert function == (kinds.text_of("rim").encode() + b"\0", b"advance")
    assert (blocks, threads, stream, extra) == (5, 3 * kinds.BLOCK_LANES, "queue", 0)
    assert shared == made.set["DYNAMIC"] == records.here["site"].itemsize * 4
    assert len(values) == len(kinds_of) == kinds.NUMBERS
    site = records.here["site"]
    size = site.itemsize
    assert values[:9] == (0, 0, 20, size, records.there["site"], 5, 4, 4 * size, size)
    assert values[-8:-2] == (0, 0, 0, kinds.kinds()["rim"]["hold"].itemsize, 0, 0)  # nothing is held by links
    assert values[-1] == 7


def test_memory_is_given_back_when_nobody_holds_the_records(drive):
    made = drive()
    records = card.CardRecords(driver.Card(), "rim", 3, 5)
    assert records.address(np.arange(10.0)) in made.memory
    del records
    assert not made.memory
    assert made.ended == ["queue"]


def test_samples_are_brought_once_and_forgotten(drive):
    made = drive()
    records = card.CardRecords(driver.Card(), "rim", 1, 1)
    samples, other = np.arange(10.0), np.arange(5.0)
    place = records.address(samples)
    assert records.address(samples) == place
    assert made.memory[place].view(float).tolist() == samples.tolist()
    gone = records.address(other)
    records.forget_samples({samples.ctypes.data})
    assert place in made.memory
    assert gone not in made.memory
    assert records.address(None) == 0


def test_smaller_columns_leave_larger_ones_their_shared_memory(drive):
    made = drive()
    device = driver.Card()
    large = card.CardRecords(device, "rim", 12, 1)
    card.CardRecords(device, "rim", 3, 1)
    assert made.set["DYNAMIC"] == large.shared


def test_a_card_is_given_as_many_lanes_as_it_advances_at_a_time(drive):
    made = drive()
    device = driver.Card()
    assert card.lanes_at_once(device, "rim", 12) == 3 * 132 * kinds.BLOCK_LANES  # three blocks a processor
    ((function, threads, shared),) = made.asked
    assert (function[1], threads) == (b"advance", 12 * kinds.BLOCK_LANES)
    assert shared == card.shared_memory(kinds.kinds()["rim"], 12)


def test_large_columns_do_not_fit(drive):
    drive()
    device = driver.Card()
    assert card.fits(device, "rim", 12)
    assert not card.fits(device, "rim", 100)  # more threads than the kernel has registers for
