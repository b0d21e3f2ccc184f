"""Figures of the running server for Prometheus: what requests did, and the state of its parts."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator, Mapping
from threading import Lock
from typing import Any

from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    ProcessCollector,
    disable_created_metrics,
    generate_latest,
)
from prometheus_client.metrics_core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from recon4 import __version__
from recon4_app.deps import ServerParts
from recon4_app.jobs.model import JobState
from recon4_app.live.capture import Capture
from recon4_app.logs import Logs
from recon4_app.network.behind import route_path
from recon4_app.network.connections import ConnectionTable, Phase
from recon4_app.tuning import METRICS

METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})
UNROUTED = "(none)"
"""Label of requests without a route; a client could invent any number of paths."""

disable_created_metrics()


class HttpMetrics:
    """Counts and times requests; labels are route templates, so the number of series is bounded."""

    def __init__(self, registry: CollectorRegistry) -> None:
        self.responses = Counter(
            "recon4_http_responses",
            "Responses by route template and status",
            ["method", "route", "status"],
            registry=registry,
        )
        self.seconds = Histogram(
            "recon4_http_response_start_seconds",
            "Time from a request's head to the start of its response",
            ["method", "route"],
            buckets=METRICS.buckets_s,
            registry=registry,
        )
        self.in_progress = Gauge(
            "recon4_http_responses_in_progress",
            "Responses begun and not finished: downloads, event streams",
            ["route"],
            registry=registry,
        )
        self.websockets = Gauge(
            "recon4_websockets_open",
            "WebSockets open: viewers, streams of a live capture",
            ["route"],
            registry=registry,
        )
        self.websockets_opened = Counter(
            "recon4_websockets_opened", "WebSockets accepted", ["route"], registry=registry
        )
        self.websockets_rejected = Counter(
            "recon4_websockets_rejected",
            "WebSockets closed before they were accepted",
            ["route"],
            registry=registry,
        )


class MetricsMiddleware:
    """Counts what every request and WebSocket comes to. Pure ASGI, before all else."""

    def __init__(self, app: ASGIApp, *, metrics: HttpMetrics) -> None:
        self._app, self._metrics = app, metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the application for one request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        request = _Request(self._metrics, scope)

        async def counted_send(message: Message) -> None:
            request.note(message)
            await send(message)

        try:
            await self._app(scope, receive, counted_send)
        except Exception:
            request.failed()
            raise
        finally:
            request.end()


class _Request:
    """Measurements of one request."""

    def __init__(self, metrics: HttpMetrics, scope: Scope) -> None:
        self._metrics, self._scope = metrics, scope
        self._began_s = time.perf_counter()
        self._open: Gauge | None = None
        self._answered = False

    def note(self, message: Message) -> None:
        """Count a message of the application."""
        if self._answered:
            return
        match message["type"]:
            case "http.response.start":
                self._respond(int(message["status"]))
                self._begin(self._metrics.in_progress)
            case "websocket.accept":
                self._metrics.websockets_opened.labels(self._route).inc()
                self._begin(self._metrics.websockets)
            case "websocket.close" | "websocket.http.response.start":
                self._metrics.websockets_rejected.labels(self._route).inc()
        self._answered = True

    def failed(self) -> None:
        """The application raised: count the status 500 that the framework sends outside of this."""
        if not self._answered and self._scope["type"] == "http":
            self._respond(500)

    def end(self) -> None:
        """The application is done with it."""
        if self._open is not None:
            self._open.dec()

    @property
    def _route(self) -> str:
        """Template of the route; known only after the application has matched it."""
        route = getattr(self._scope.get("route"), "path", None)
        if route is None:
            return "/web" if route_path(self._scope).startswith("/web/") else UNROUTED
        return str(route)

    def _respond(self, status: int) -> None:
        method = self._scope["method"]
        method = method if method in METHODS else "other"
        self._metrics.responses.labels(method, self._route, str(status)).inc()
        elapsed_s = time.perf_counter() - self._began_s
        self._metrics.seconds.labels(method, self._route).observe(elapsed_s)

    def _begin(self, gauge: Gauge) -> None:
        self._open = gauge.labels(self._route)
        self._open.inc()


class ConnectionCollector(Collector):
    """Connections, and log records that were not written."""

    def __init__(self, table: ConnectionTable, logs: Logs) -> None:
        self._table, self._logs = table, logs

    def collect(self) -> Iterator[Metric]:
        """The present figures."""
        counts = self._table.counts
        yield _gauges(
            "recon4_connections_open",
            "Open connections by phase",
            label="phase",
            values={phase: self._table.open_in(phase) for phase in Phase},
        )
        limits = {"total": self._table.limits.total, "address": self._table.limits.per_address}
        yield _gauges("recon4_connections_limit", "Limits", label="of", values=limits)
        yield CounterMetricFamily(
            "recon4_connections_accepted", "Connections accepted", value=counts.accepted
        )
        for name, text, label, values in (
            ("rejected", "Connections closed without a request", "reason", counts.rejected),
            ("evicted", "Connections closed to make room for new ones", "phase", counts.evicted),
            ("timeouts", "Deadlines missed by clients", "deadline", counts.timeouts),
        ):
            yield _counters(f"recon4_connections_{name}", text, label=label, values=values)
        yield _counters(
            "recon4_accept_errors",
            "Connections the system could not hand over",
            label="error",
            values=counts.accept_errors,
        )
        yield CounterMetricFamily(
            "recon4_log_records_suppressed",
            "Log records not written because they repeated",
            value=self._logs.dropped,
        )
        yield CounterMetricFamily(
            "recon4_log_write_failures",
            "Log records the log file could not take",
            value=self._logs.failures,
        )


class PartsCollector(Collector):
    """Queue, stages, live capture and disk."""

    def __init__(self, parts: ServerParts) -> None:
        self._parts = parts
        self._version = 0
        self._seen: set[tuple[str, int, str]] = set()
        self._stage_seconds: dict[str, float] = {}
        self._stage_runs: dict[str, float] = {}

    def collect(self) -> Iterator[Metric]:
        """The present figures."""
        counted = self._parts.jobs.counts()
        jobs = {state: counted.get(state, 0) for state in JobState}
        yield _gauges("recon4_jobs", "Jobs by state", label="state", values=jobs)
        yield GaugeMetricFamily(
            "recon4_queue_length", "Jobs that wait for a worker", value=jobs[JobState.QUEUED]
        )
        yield from self._stages()
        disk = shutil.disk_usage(self._parts.settings.root)
        yield GaugeMetricFamily("recon4_disk_free_bytes", "Free disk space", value=disk.free)
        yield GaugeMetricFamily("recon4_disk_total_bytes", "Size of the disk", value=disk.total)
        current_capture = self._parts.current_capture
        yield GaugeMetricFamily(
            "recon4_live_clients", "Clients of the live capture", value=current_capture.streams.open
        )
        running = current_capture.newest is not None and not current_capture.newest.over
        yield GaugeMetricFamily("recon4_live_captures", "Live captures that run", value=running)
        if current_capture.newest is not None:
            yield from _capture(current_capture.newest)

    def _stages(self) -> Iterator[Metric]:
        """Stages that ended since the server started, of the jobs something happened to."""
        supervisor = self._parts.supervisor
        since, self._version = self._version, supervisor.version
        for job_id in supervisor.touched_since(since):
            job = self._parts.jobs.get(job_id)
            for stage in supervisor.status(job).stages:
                key = job_id, job.attempt, stage.stage
                if stage.seconds is None or stage.state != "done" or key in self._seen:
                    continue
                self._seen.add(key)
                name = stage.stage
                self._stage_seconds[name] = self._stage_seconds.get(name, 0.0) + stage.seconds
                self._stage_runs[name] = self._stage_runs.get(name, 0.0) + 1
        for name, text, values in (
            ("recon4_stage_seconds", "Time stages took", self._stage_seconds),
            ("recon4_stage_runs", "Stages run to their end", self._stage_runs),
        ):
            yield _counters(name, text, label="stage", values=values)


class Metrics:
    """The registry of one server."""

    def __init__(self, table: ConnectionTable, logs: Logs) -> None:
        self._registry = CollectorRegistry()
        self.http = HttpMetrics(self._registry)
        ProcessCollector(registry=self._registry)
        self._registry.register(ConnectionCollector(table, logs))
        self._lock = Lock()
        self._began_s = time.monotonic()
        self._uptime = Gauge(
            "recon4_uptime_seconds", "Since the server started", registry=self._registry
        )
        self._uptime.set_function(lambda: time.monotonic() - self._began_s)
        version = Gauge(
            "recon4_build_info", "Version of the program", ["version"], registry=self._registry
        )
        version.labels(__version__).set(1)

    def follow(self, parts: ServerParts) -> None:
        """Include the parts of a server that has started."""
        self._registry.register(PartsCollector(parts))

    def text(self) -> bytes:
        """All figures in Prometheus' text format; called from any thread."""
        with self._lock:  # the stages are added up while they are collected
            return generate_latest(self._registry)


def _capture(capture: Capture) -> Iterator[Metric]:
    """Packets of the live capture that runs, or of the last one."""
    newest = capture.stream.newest
    status, notes = newest.status, newest.notes
    if status is not None:
        yield _gauges(
            "recon4_live_packets_dropped",
            "Packets of the live capture that are not in its recording",
            label="reason",
            values={
                "kernel": status.kernel_drops,
                "disk": status.file.dropped,
                "paused": status.skipped_in_pauses,
            },
        )
        yield GaugeMetricFamily(
            "recon4_live_packets_recorded",
            "Packets in the recording",
            value=status.file.datagrams,
        )
    if notes is not None:
        yield _gauges(
            "recon4_live_packets_read",
            "What the reader of the recording counted, rejected packets included",
            label="what",
            values=notes.counts,
        )


def _gauges(name: str, text: str, *, label: str, values: Mapping[Any, float]) -> Metric:
    family = GaugeMetricFamily(name, text, labels=[label])
    for value_of, value in values.items():
        family.add_metric([str(value_of)], value)
    return family


def _counters(name: str, text: str, *, label: str, values: Mapping[Any, float]) -> Metric:
    family = CounterMetricFamily(name, text, labels=[label])
    for value_of, value in list(values.items()):
        family.add_metric([str(value_of)], value)
    return family
