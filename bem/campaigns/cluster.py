"""Jobs on a Dask cluster; needs the extra `bem-tribology[dask]`."""

from __future__ import annotations

import secrets
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from bem.campaigns.context import Silent
from bem.errors import InputError, ResultsError

if TYPE_CHECKING:
    from bem.campaigns.job import Sent

_ANSWER_WITHIN = "10s"
"""Time that a scheduler has to answer."""


def compute_on_cluster(jobs: Iterable[Sent], scheduler: str) -> Iterator[tuple[int, Any]]:
    """Do jobs on the workers of a scheduler such as `tcp://10.0.0.1:8786`, yielding index and result of each.

    A job whose worker dies goes to another one, and on from its checkpoint where both see the same disk. Progress is
    that of whole jobs; notes come with the results.

    Raises
    ------
    InputError : Dask is not installed, the scheduler does not answer, or a worker has another version of bem.
    ResultsError : the scheduler is gone.
    """
    try:
        import distributed
    except ImportError:
        raise InputError("--scheduler: dask is not installed; allowed: pip install 'bem-tribology[dask]'") from None
    try:
        client = distributed.Client(scheduler, timeout=_ANSWER_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f'--scheduler "{scheduler}": no Dask scheduler answers there ({error}); '
            'allowed: its address, such as "tcp://127.0.0.1:8786"'
        ) from None
    with client:
        _check_versions(client)
        token = secrets.token_hex(8)
        futures = {
            client.submit(_compute, job, key=f"bem-{token}-{job.index}", pure=False, retries=2): job for job in jobs
        }
        try:
            for future in distributed.as_completed(futures, loop=client.loop):
                job = futures[future]
                failure = future.exception()
                if future.status == "cancelled":
                    raise ResultsError("--scheduler: the scheduler is gone; the same command with --resume goes on")
                lost = None if failure is None else job.lost(f"{type(failure).__name__}: {failure}")
                yield job.index, future.result() if failure is None else lost
                future.release()
        finally:
            client.cancel(list(futures), force=True)


def _compute(job: Sent) -> Any:
    return job.compute(Silent())


def bem_version() -> str:
    """The version of `bem` where this is called, for comparing workers."""
    import bem

    return str(bem.__version__)


def _check_versions(client: Any) -> None:
    ours = bem_version()
    others = {name: version for name, version in client.run(bem_version).items() if version != ours}
    if others:
        raise InputError(
            f"--scheduler: workers have other versions of bem ({', '.join(sorted(set(others.values())))}); "
            f"allowed: {ours} everywhere"
        )
