"""What happens by itself while the server runs: changes are saved, sessions that nobody uses end."""

import threading
import time

from assess.web.sessions import Keys, Session

SAVED_AFTER = 1.0
"""Time from the last change of a workbook to its being saved [s]; longer where saving itself takes long."""
SAVED_AT_LATEST = 3.0
"""Time from the first change that is not saved to its being saved, however much is changed after it [s]; as above."""
SAVED_AGAIN_AFTER = 3.0
"""Time after which saving that has failed is tried again [s]."""
SAVING_SHARE = 0.3
"""Most of the time that saving may take while a workbook is being changed [-]."""
LOOKED_EVERY = 60.0
"""Time between two looks for sessions that have ended [s]."""


class Keeper:
    """Saves workbooks of the disk a moment after their last change, and ends sessions, in a thread of its own."""

    def __init__(self, keys: Keys) -> None:
        self._keys, self._due = keys, dict[Session, float]()
        self._latest = dict[Session, float]()
        self._took = 0.0  # by the last save [s]
        self._woken, self._is_ended = threading.Condition(), False
        self._next_look = time.monotonic() + LOOKED_EVERY
        self._thread = threading.Thread(target=self._run, name="assess-keeper", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def note_edit(self, session: Session) -> None:
        """Have a workbook be saved, once nothing more is changed for a moment, or soon."""
        if session.book is not None and session.book.mode == "disk":
            with self._woken:
                now, pause = time.monotonic(), self._took / SAVING_SHARE
                latest = self._latest.setdefault(session, now + max(SAVED_AT_LATEST, pause))
                self._due[session] = min(now + max(SAVED_AFTER, pause), latest)
                self._woken.notify()

    def _try_again(self, session: Session) -> None:
        """Have a workbook that could not be saved be saved a little later: what stood in the way may be gone."""
        state = session.book.state() if session.book else {}
        if state.get("unsaved") and state["save_error"] and not state["changed_outside"]:
            with self._woken:
                self._due.setdefault(session, time.monotonic() + max(SAVED_AGAIN_AFTER, self._took / SAVING_SHARE))

    def end(self) -> None:
        """End, after what is being saved."""
        with self._woken:
            self._is_ended = True
            self._woken.notify()
        self._thread.join()

    def _run(self) -> None:
        while (sessions := self._wait()) is not None:
            for session in sessions:
                started = time.monotonic()
                session.save()
                self._took = time.monotonic() - started
                self._try_again(session)
            if time.monotonic() >= self._next_look:
                self._next_look = time.monotonic() + LOOKED_EVERY
                self._keys.expire(time.monotonic())

    def _wait(self) -> list[Session] | None:
        with self._woken:
            while not self._is_ended:
                now = time.monotonic()
                due = [session for session, at in self._due.items() if at <= now]
                if due or now >= self._next_look:
                    for session in due:
                        del self._due[session]
                        self._latest.pop(session, None)
                    return due
                self._woken.wait(min(*self._due.values(), self._next_look, self._next_look) - now)
        return None
