"""Points on a Dask cluster; needs the extra `bem[dask]`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from bem.errors import InputError, ResultsError
from bem.sweeps.point import Done, Point, bem_version, compute


def compute_on_cluster(points: Iterable[Point], scheduler: str) -> Iterator[Done]:
    """Compute points on the workers of a scheduler such as `tcp://10.0.0.1:8786`, yielding each as it ends.

    A point whose worker dies goes to another one, and on from its checkpoint where both see the same disk; where a
    worker does not see the sweep's folder, it computes in a temporary one and sends the files.

    Raises
    ------
    InputError : Dask is not installed, the scheduler does not answer, or a worker has another version of bem.
    ResultsError : the scheduler is gone.
    """
    try:
        import distributed
    except ImportError:
        raise InputError("--scheduler: dask is not installed; allowed: with `pip install bem[dask]`") from None
    try:
        client = distributed.Client(scheduler, timeout="10s", set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f'--scheduler "{scheduler}": no Dask scheduler answers there ({error}); '
            'allowed: its address, such as "tcp://127.0.0.1:8786"'
        ) from None
    with client:
        _check_versions(client)
        futures = {
            client.submit(compute, point, key=f"bem-{point.token}-{point.index}", pure=False, retries=2): point
            for point in points
        }
        try:
            for future in distributed.as_completed(futures, loop=client.loop):
                point = futures[future]
                failure = future.exception()
                if future.status == "cancelled":
                    raise ResultsError("--scheduler: the scheduler is gone; the same command with --resume goes on")
                yield future.result() if failure is None else Done(point.index, f"{type(failure).__name__}: {failure}")
                future.release()
        finally:
            client.cancel(list(futures), force=True)


def _check_versions(client: Any) -> None:
    ours = bem_version()
    others = {name: version for name, version in client.run(bem_version).items() if version != ours}
    if others:
        raise InputError(
            f"--scheduler: workers have other versions of bem ({', '.join(sorted(set(others.values())))}); "
            f"allowed: {ours} everywhere"
        )
