"""The threshold at which a method keeps a rate of false alarms."""

import signal
import threading

import pytest

import apertura as ap


def test_the_threshold_keeps_the_rate_on_the_scenes_that_chose_it():
    parts = []
    found = ap.threshold("baseline", false_alarm_percent=40, sets=[1, "2"], count=2, progress=parts.append)
    assert found.scenes == 4 and 0 <= found.eta < 1 and 0 <= found.detection <= 1
    assert (4 * found.false_alarm + 1) / 5 <= 0.4
    assert found.left_to_scenes == pytest.approx((5 * 0.4 - 1) / 4) and found.scenes_within_a_tenth == 15
    assert parts == sorted(parts) and parts[-1] == 1.0
    assert found == ap.threshold("baseline", false_alarm_percent=40, sets=["1", 2], count=2)


def test_a_rate_that_cannot_be_kept_is_explained():
    with pytest.raises(ValueError, match="50 scenes can't keep a rate of 1 %; take 99 scenes or more"):
        ap.threshold("baseline", sets=["1"], count=50)
    with pytest.raises(ValueError, match="have no echoes"):
        ap.threshold("baseline", sets=["noise"])
    with pytest.raises(ValueError, match="given twice"):
        ap.threshold("baseline", sets=[1, 1])
    with pytest.raises(ValueError, match="a rate of 0 %"):
        ap.threshold("baseline", false_alarm_percent=0)
    with pytest.raises(ValueError, match="no such method"):
        ap.threshold("no such method")


def test_ctrl_c_stops_the_search():
    # A shell starts what runs in the background with Ctrl-C ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ap.threshold("baseline", sets=["1"], count=100_000)
    timer.join()


def test_a_layout_has_a_threshold_of_its_own():
    of = lambda layout: ap.threshold("matched-filter", false_alarm_percent=50, sets=[1], count=2, layout=layout).eta
    assert of(ap.layout("nested=12x12")) != of(None)
    with pytest.raises(ValueError, match="0 to 1023"):
        of([0, 1024])


def test_robustness_hears_a_layout():
    of = lambda layout: ap.robustness(["matched-filter"], 1, scales=[1], count=1, layout=layout)[0]["squared_error"]
    assert of(ap.layout("nested=12x12")) != of(None)
    with pytest.raises(ValueError, match="0 to 1023"):
        of([0, 1024])
