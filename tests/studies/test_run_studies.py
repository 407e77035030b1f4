"""Progress of studies, and cancelling: what is reported, and that a cancelled study writes nothing."""

from threading import Event

import pytest

from assess.errors import CancelledError
from assess.progress import Progress, Report
from assess.studies import Finding, Options, Study, run_all, run_study


def made_up(name, steps, each=lambda _: None):
    def run(options):
        for step, part in options.each(range(steps)):
            for half, _ in part.each("ab"):
                each((step, half))
        return Finding(page=["a page"])

    return Study(name=name, order=1, title=f"Of {name}", of="section 1", run=run)


def test_a_study_is_one_stage_and_its_shares_grow(tmp_path):
    reports: list[Report] = []
    run_all([made_up("one", 2), made_up("other", 1)], Options(out=tmp_path), Progress(reports.append))
    shares = {name: [one.share for one in reports if one.stage == name] for name in ("one", "other")}
    assert shares["one"] == [0.0, 0.0, 0.0, 0.25, 0.5, 0.5, 0.75, 1.0]
    assert shares["other"] == [0.0, 0.0, 0.0, 0.5, 1.0]
    assert reports[0].detail == "Of one"


def test_a_cancelled_study_ends_at_its_next_step_and_writes_nothing(tmp_path):
    cancel, done = Event(), []

    def cancel_at(step):
        done.append(step)
        if step == (1, "a"):
            cancel.set()

    with pytest.raises(CancelledError):
        run_study(made_up("one", 9, cancel_at), Options(out=tmp_path / "out"), Progress(cancel=cancel))
    assert done == [(0, "a"), (0, "b"), (1, "a")]
    assert not (tmp_path / "out").exists()


def test_a_real_study_is_cancelled_before_its_long_work(tmp_path):
    from assess.studies import all_studies

    cancel = Event()
    reports: list[Report] = []

    def listen(report):
        reports.append(report)
        if len(reports) == 4:
            cancel.set()

    study = next(one for one in all_studies() if one.name == "solver")
    with pytest.raises(CancelledError):
        run_study(study, Options(out=tmp_path / "out"), Progress(listen, cancel))
    assert len(reports) == 4
    assert not (tmp_path / "out").exists()
