"""Connections that are closed where they keep the server waiting for the head of a request."""

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

SILENT = b"HTTP/1.1 408 Request Timeout\r\nconnection: close\r\ncontent-length: 0\r\n\r\n"


class Connection(H11Protocol):
    """HTTP as uvicorn has it; a head that is not whole after `silence` [s] ends the connection."""

    silence = 20.0
    _late: asyncio.TimerHandle | None = None
    _has_begun = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for the first request."""
        super().connection_made(transport)
        self._late = self.loop.call_later(self.silence, self._end)

    def data_received(self, data: bytes) -> None:
        """Wait for the rest of a head that has begun; bodies are waited for by who reads them."""
        super().data_received(data)
        self._has_begun = self.cycle is None or self.cycle.response_complete
        if not self._has_begun:
            self._stop()
        elif self._late is None:
            self._late = self.loop.call_later(self.silence, self._end)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no longer."""
        self._stop()
        super().connection_lost(exc)

    def _stop(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _end(self) -> None:
        if not self.transport.is_closing():
            if self._has_begun:
                self.transport.write(SILENT)
            self.transport.close()


def limit_silence(seconds: float) -> Any:
    """Return the class of connections that wait so long [s]."""
    return type("LimitedConnection", (Connection,), {"silence": seconds})
