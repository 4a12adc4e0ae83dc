"""Variants computed by the workers of a Dask cluster."""

import asyncio
import importlib
from collections.abc import Iterator
from typing import Any

from sfd_hbm_ros.study.errors import IncompleteError
from sfd_hbm_ros.study.processes import Variants
from sfd_hbm_ros.study.task import Outcome, Task

_PATIENCE = 10.0  # with a scheduler that does not answer [s]
_LINE = "\n"  # Dask's errors go on for several


def on_cluster(task: Task, variants: Variants, address: str) -> Iterator[tuple[int, Outcome]]:
    """Compute variants, and yield each with its number as it is ready.

    What a lost worker had to do, the scheduler hands to the others.

    Parameters
    ----------
    task : Task
        How a variant is computed.
    variants : mapping of int to sequence of float
        The values of each variant by its number.
    address : str
        Address of the scheduler, such as ``tcp://192.168.0.1:8786``.

    Raises
    ------
    ModuleNotFoundError
        If `distributed` is not installed.
    OSError
        If no scheduler answers there.
    IncompleteError
        At the end, if the cluster gave variants up or its workers could not begin with them.
    """
    try:
        distributed = importlib.import_module("distributed")  # optional, and slow to import
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            f"--scheduler {address}: needs the Python package distributed, which is not installed"
        ) from None
    with _client(distributed, address) as client:
        futures = client.map(task.outcome, list(variants.values()), pure=False)
        numbers = dict(zip(futures, variants, strict=True))
        failures = []
        for future in distributed.as_completed(futures, loop=client.loop):
            if future.status == "finished":
                yield numbers[future], future.result()
            else:
                failures.append(str(future.exception() if future.status == "error" else "lost"))
        if failures:
            raise IncompleteError(
                f"--scheduler {address}: {len(failures)} variants failed on the cluster, the last "
                f"with: {failures[-1].partition(_LINE)[0]}; the same command tries them again"
            )


def _client(distributed: Any, address: str) -> Any:
    """A client of the scheduler; a client that finds none does not end by itself, so ask first."""
    try:
        kind = asyncio.run(asyncio.wait_for(_asked(distributed, address), _PATIENCE))
        if kind != "Scheduler":
            raise OSError(f"what answers is a Dask {kind}")
        return distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except Exception as error:  # from sockets, from names, and from what else may listen there
        reason = str(error).partition(_LINE)[0] or "no answer in time"
        raise OSError(f"--scheduler {address}: no Dask scheduler answers: {reason}") from None


async def _asked(distributed: Any, address: str) -> str:
    """What kind of server is at an address by its own words."""
    security = distributed.Security().get_connection_args("client")
    link = await distributed.comm.connect(address, timeout=_PATIENCE, **security)
    try:
        await link.write({"op": "identity", "reply": True})
        return str((await link.read()).get("type"))
    finally:
        link.abort()
