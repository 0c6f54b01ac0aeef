"""Linear algebra on one thread: its sums have one order, so that the same program gives the same bits.

Small matrices gain nothing by more threads, and where the processor is busy with other things they lose much:
threads that wait for each other spin.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, TypeVar

Item = TypeVar("Item")


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep the linear algebra of this process to one thread; behind it to as many as before."""
    pools = _pools()
    before = [pool.get_num_threads() for pool in pools]
    more = [(pool, count) for pool, count in zip(pools, before, strict=True) if count not in (None, 1)]
    for pool, _ in more:
        pool.set_num_threads(1)
    try:
        yield
    finally:
        for pool, count in more:
            pool.set_num_threads(count)


def worked_out_on_one_thread(items: Iterator[Item]) -> Iterator[Item]:
    """The same items; between two of them whoever takes them has the threads that he had."""
    while True:
        with one_thread():
            try:
                item = next(items)
            except StopIteration:
                return
        yield item


@cache
def _pools() -> tuple[Any, ...]:
    """Controllers of the libraries of linear algebra, once all that irlx uses are loaded."""
    import scipy.linalg  # noqa: F401  # brings a library of its own, which has to be there to be found
    from threadpoolctl import ThreadpoolController

    return tuple(ThreadpoolController().select(user_api="blas").lib_controllers)
