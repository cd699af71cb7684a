"""Run the tasks of an archive on a Dask cluster. Only this module imports ``distributed``."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from cobotwire.capture.export.extras import needed
from cobotwire.protocol.errors import LinkError

Task = TypeVar("Task")
Result = TypeVar("Result")
# A running scheduler answers at once.
CONNECT_SECONDS = 10


class DaskEngine:
    """Runs tasks on a Dask cluster; it starts one on this machine if no scheduler is given.

    If a worker dies, the scheduler gives its tasks to others.
    """

    def __init__(self, scheduler: str | None = None, workers: int | None = None) -> None:
        """Use the scheduler at an address such as ``tcp://10.0.0.5:8786``.

        ``workers`` is the number of processes of a cluster on this machine, by default one for
        each processor.

        Raises:
            UsageError: Dask is not installed.
        """
        self._distributed = needed("distributed", "dask", "the Dask engine")
        self._scheduler = scheduler
        self._workers = workers or os.cpu_count() or 1

    def run(
        self, function: Callable[[Task], Result], tasks: Sequence[Task]
    ) -> Iterator[tuple[int, Result]]:
        """Yield the results.

        Raises:
            LinkError: the scheduler does not answer, or a task kills each worker that gets it.
        """
        with self._client() as client:
            # The tasks write files. ``pure=False`` makes Dask run them again in a second call.
            futures = client.map(function, tasks, pure=False)
            numbers = {future.key: number for number, future in enumerate(futures)}
            try:
                for future in self._distributed.as_completed(futures):
                    yield numbers[future.key], self._result(future)
                    future.release()
            finally:
                client.cancel(futures)

    def _result(self, future: Any) -> Any:
        try:
            return future.result()
        except self._distributed.KilledWorker as error:
            detail = "every worker that had this task died: is their memory too small for a piece?"
            raise LinkError(self._scheduler or "the Dask cluster", detail) from error

    @contextmanager
    def _client(self) -> Iterator[Any]:
        if self._scheduler is not None:
            try:
                client = self._distributed.Client(self._scheduler, timeout=CONNECT_SECONDS)
            except (OSError, ValueError) as error:
                detail = f"no Dask scheduler answers: {error}"
                raise LinkError(self._scheduler, detail) from error
            with client:
                yield client
            return
        # A worker has one thread, so that workers share neither memory nor an interpreter's lock.
        with (
            self._distributed.LocalCluster(
                self._workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address="127.0.0.1:0",
                # An error is raised here; the workers need not print it, too.
                silence_logs=logging.CRITICAL,
            ) as cluster,
            self._distributed.Client(cluster) as client,
        ):
            yield client
