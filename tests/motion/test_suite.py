"""A folder of one's own records in place of generated motions."""

import dataclasses
import hashlib
import shutil
from pathlib import Path

import numpy as np
import pytest

from assess.errors import RecordError
from assess.motion.spectrum import response_spectrum
from assess.motion.suite import MOST_SPECTRA, read_suite
from assess.units import GRAVITY
from tests.motion.motions import MARKET, read_motion
from tests.shaking import write_record

TIME = np.arange(400)
WAVE = np.sin(TIME / 20) * np.exp(-TIME / 150)

FEW_NOTE = "{} motions are few: the probabilities have wide intervals"
ONLY_NOTE = "only 1 motion: the probabilities have wide intervals"


def test_motions_are_treated_and_in_the_order_of_steps_and_names(tmp_path: Path) -> None:
    for name, step in (("c", 0.01), ("a", 0.02), ("b", 0.01)):
        write_record(tmp_path / f"{name}.csv", 0.2 * WAVE, step)
    suite = read_suite(tmp_path)
    assert [name for name, _ in suite.motions] == ["b.csv", "c.csv", "a.csv"]
    assert (len(suite), suite.folder, suite.notes) == (3, tmp_path.name, (FEW_NOTE.format(3),))
    shutil.copy(MARKET / "891018_1.cra-1.0210a.smc", tmp_path / "x.smc")
    (motion,) = [motion for name, motion in read_suite(tmp_path).motions if name == "x.smc"]
    np.testing.assert_array_equal(motion.acceleration, read_motion("a").acceleration)


def test_files_are_hashed_and_texts_hidden_files_and_folders_are_passed_over(tmp_path: Path) -> None:
    path = write_record(tmp_path / "a.csv", WAVE)
    assert read_suite(tmp_path).files == {"a.csv": hashlib.sha256(path.read_bytes()).hexdigest()}
    for name in ("README.md", "page.html", "page.HTM", "paper.pdf", "notes.rst", ".DS_Store", ".a.csv"):
        (tmp_path / name).write_text("not a record", encoding="utf-8")
    (tmp_path / "more").mkdir()
    write_record(tmp_path / "more" / "b.csv", WAVE)
    assert [name for name, _ in read_suite(tmp_path).motions] == ["a.csv"]


def test_vertical_channels_are_left_out_and_named(tmp_path: Path) -> None:
    for channel in "afj":
        shutil.copy(MARKET / f"891018_1.cra-1.0210{channel}.smc", tmp_path / f"{channel}.smc")
    suite = read_suite(tmp_path)
    assert "a.smc" in [name for name, _ in suite.motions]
    note, few = suite.notes
    assert few == (ONLY_NOTE if len(suite) == 1 else FEW_NOTE.format(len(suite)))
    assert note.startswith("vertical channels are left out: ")
    assert len(suite) + note.count(".smc#") == 3


def test_a_folder_that_is_not_there_or_without_horizontal_channels(tmp_path: Path) -> None:
    (tmp_path / "README.md").write_text("empty", encoding="utf-8")
    with pytest.raises(RecordError, match=r"the folder holds no horizontal channel\. Put floor records into it"):
        read_suite(tmp_path)
    with pytest.raises(RecordError, match=r"none: there is no such folder\. Name a folder of floor records"):
        read_suite(tmp_path / "none")
    path = write_record(tmp_path / "a.csv", WAVE)
    with pytest.raises(RecordError, match=r"a\.csv: there is no such folder"):
        read_suite(path)


def test_a_file_that_is_no_record_is_named(tmp_path: Path) -> None:
    write_record(tmp_path / "a.csv", WAVE)
    for content in (b"", b"nothing of use\n", b"\x89PNG\r\n\x1a\n\0\0\0"):
        (tmp_path / "odd.txt").write_bytes(content)
        with pytest.raises(RecordError, match=r"odd\.txt"):
            read_suite(tmp_path)


def test_motions_of_one_step_make_a_batch_and_shorter_ones_rest_at_their_end(tmp_path: Path) -> None:
    write_record(tmp_path / "a.csv", WAVE)
    write_record(tmp_path / "b.csv", WAVE[:250])
    write_record(tmp_path / "c.csv", WAVE, 0.02)
    suite = read_suite(tmp_path)
    (short, step), (long, other) = suite.realise(0, 3)
    assert (short.shape, step, long.shape, other) == ((2, 400), 0.01, (1, 400), 0.02)
    for row, (_, motion) in zip((*short, *long), suite.motions, strict=True):
        np.testing.assert_array_equal(row[: motion.acceleration.size], motion.acceleration)
        assert not row[motion.acceleration.size :].any()
    ((last, _),) = suite.realise(2, 1)
    np.testing.assert_array_equal(last, long)
    ((middle, _), _) = suite.realise(1, 2)
    np.testing.assert_array_equal(middle[0], short[1][:250])


def test_each_is_scaled_to_a_pfa(tmp_path: Path) -> None:
    for number in (1, 2, 3):
        write_record(tmp_path / f"{number}.csv", 0.1 * number * WAVE)
    suite = read_suite(tmp_path)
    before = [motion.acceleration.copy() for _, motion in suite.motions]
    ((scaled, _),) = suite.realise(0, 3, 0.25 * GRAVITY)
    np.testing.assert_allclose(np.abs(scaled).max(axis=1), 0.25 * GRAVITY)
    for row, one, (_, motion) in zip(scaled, before, suite.motions, strict=True):
        np.testing.assert_allclose(row / row.max(), one / one.max(), atol=1e-12)
        np.testing.assert_array_equal(motion.acceleration, one)
    ((given, _),) = suite.realise(0, 3)
    assert len(set(np.abs(given).max(axis=1))) == 3


def test_spectra_of_motions_of_several_steps_of_the_first_hundred_only(tmp_path: Path) -> None:
    """The second has the same samples at twice the step; a shorter one is followed by rest."""
    for name, size, step in (("a", 400, 0.01), ("b", 400, 0.02), ("c", 300, 0.01)):
        write_record(tmp_path / f"{name}.csv", 0.2 * WAVE[:size], step)
    suite = read_suite(tmp_path)
    spectra, scaled = suite.scaled_spectra(), suite.scaled_spectra(3.0)
    assert (spectra.target, spectra.ordinates.shape) == (None, (3, spectra.periods.size))
    batches = [(motion, step) for batch, step in suite.realise(0, 3) for motion in batch]
    for (motion, step), own, to_peak in zip(batches, spectra.ordinates, scaled.ordinates, strict=True):
        expected = response_spectrum(motion, step, spectra.periods).pseudo
        np.testing.assert_allclose(own, expected, rtol=1e-6)
        np.testing.assert_allclose(to_peak, expected * 3.0 / np.abs(motion).max(), rtol=1e-6)
    many = dataclasses.replace(suite, motions=suite.motions * 40)
    assert len(many.scaled_spectra(1.0).ordinates) == MOST_SPECTRA == 100
