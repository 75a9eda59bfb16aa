"""Figures of a running server for Prometheus: requests, sessions, jobs, workers, frames, the queue and the store."""

from __future__ import annotations

from collections import Counter as Count
from collections.abc import Iterable
from typing import Any

import prometheus_client
from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric

TYPE = prometheus_client.CONTENT_TYPE_LATEST
BUCKETS = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 100.0, 300.0)
METHODS = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "WEBSOCKET"}

prometheus_client.disable_created_metrics()  # type: ignore[no-untyped-call]


class Metrics:
    """The figures of one server. `state` is the application's: pool, store, sessions are read when asked."""

    def __init__(self, state: Any) -> None:
        self.registry = CollectorRegistry(auto_describe=False)
        self.requests = Histogram(
            "http_request_duration_seconds",
            "Time from a request to the end of its answer [s]",
            ("method", "route", "status"),
            buckets=BUCKETS,
            registry=self.registry,
        )
        self.rejected = Counter("rejected", "Answers that were problems", ("problem",), registry=self.registry)
        self.registry.register(_Present(state))

    def request(self, method: str, route: str, status: int, seconds: float, problem: str) -> None:
        """A request has ended; WebSockets count as rejected only, as they last as long as a client watches."""
        if method != "WEBSOCKET":
            self.requests.labels(self.method(method), route, str(status)).observe(seconds)
        if problem:
            self.rejected.labels(problem).inc()

    @staticmethod
    def method(given: str) -> str:
        """The method, or `OTHER`: clients may not make labels."""
        return given if given in METHODS else "OTHER"

    def text(self) -> bytes:
        """All figures as Prometheus reads them."""
        return generate_latest(self.registry)


class _Present:
    """The figures at the time of the request."""

    def __init__(self, state: Any) -> None:
        self.state = state

    def collect(self) -> Iterable[Metric]:
        """Sessions, jobs, workers, frames, the queue and the store."""
        pool, sessions, store = self.state.pool, self.state.sessions, self.state.store
        live = list(sessions.sessions.values())
        yield _by_state("sessions", "Sessions by status", Count(_standing(one) for one in live))
        awake = sum(one.process is not None for one in live)
        sweeps = self.state.jobs.local.pool
        workers = Count(pool.states()) + Count(sweeps.states())
        states = dict.fromkeys(pool.states(), 0) | workers | {"session": awake}
        yield _by_state("workers", "Processes by activity", states)
        yield _by_state("jobs", "Jobs by status", self.state.jobs.states())
        yield _counted("frames_sent", "Frames sent to clients", sessions.frames_sent)
        yield _counted("frames_skipped", "Frames dropped for slow clients", sessions.frames_skipped)
        queue = max(0, pool.taken - pool.settings.lanes)
        yield GaugeMetricFamily("queue_depth", "Requests that wait for a worker", value=queue)
        yield GaugeMetricFamily("checkpoint_seconds", "Time of the last write to the store [s]", value=store.seconds)
        yield GaugeMetricFamily("store_failing", "1 while the disk refuses writes", value=float(bool(store.failing)))
        yield _counted("worker_restarts", "Processes replaced", pool.restarts + sweeps.restarts + sessions.restarts)


def _standing(live: Any) -> str:
    return "running" if live.playing else str(live.described.get("status", "starting"))


def _by_state(name: str, words: str, counts: Any) -> Metric:
    family = GaugeMetricFamily(name, words, labels=("state",))
    for state, count in sorted(counts.items()):
        family.add_metric((state,), count)
    return family


def _counted(name: str, words: str, value: float) -> Metric:
    return CounterMetricFamily(name, words, value=value)
