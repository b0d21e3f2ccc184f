"""Settings of the server. The only place of ``app`` that reads the environment."""

from __future__ import annotations

import ipaddress
import os
from dataclasses import dataclass
from pathlib import Path

import recon4
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, at
from recon4.sandbox import ONE_THREAD as ONE_THREAD
from recon4.sandbox import allowed_environment
from recon4.untrusted.names import is_unnameable, visible
from recon4_app.network.behind import PublicAddress

Network = ipaddress.IPv4Network | ipaddress.IPv6Network


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerSettings:
    """Settings with which a server is started."""

    root: Path
    """Folder that holds the project folders."""
    host: str = "127.0.0.1"
    """Address to listen on; loopback only unless ``lan``."""
    port: int = 8000
    """Port to listen on; 0 = any free one."""
    lan: bool = False
    """TLS and login together; neither goes without the other."""
    behind: PublicAddress | None = None
    """Address of the reverse proxy on this computer that does TLS for the server; with login."""
    tls_certificate: Path | None = None
    """The user's own certificate chain, PEM; None = one is made."""
    tls_key: Path | None = None
    """Its key, PEM."""
    allowed_hosts: tuple[str, ...] = ()
    """Host names browsers may use, besides those this computer knows of itself; ``lan`` only."""
    recording_folders: tuple[Path, ...] = ()
    """Folders a job may read recordings from, besides ``root``."""
    max_running_jobs: int = 1
    """Jobs that run at the same time; the others wait."""
    max_running_exports: int = 1
    """Exports that run at the same time, beside the jobs; the others wait."""
    max_job_attempts: int = 3
    """A job whose worker died this many times fails."""
    hung_after_s: float = 120.0
    """A worker that makes no progress for this long is killed, ten times later where a stage
    computes on its own data [s]."""
    stop_within_s: float = 10.0
    """A worker asked to stop is killed after this long [s]."""
    viewer_idle_s: float = 600.0
    """A viewer without browsers ends after this long [s]."""
    viewer_points: int = 3_000_000
    """Point budget of one browser; phones get fewer."""
    viewer_sockets: int = 32
    """Most viewers open at the same time."""
    viewer_sockets_a_person: int = 8
    """Most of them per person."""
    max_connections: int = 1024
    """Most open connections; fewer where the limit of open files is low."""
    max_connections_per_address: int = 256
    """Most of them per address; phones behind one router share an address."""
    worker_module: str = "recon4_app.jobs.worker"
    """Module run for a job."""
    max_body_bytes: int = 1 << 20
    """Largest request body [bytes]."""
    max_waiting_jobs: int = 20
    """Most jobs in the queue; more are rejected."""
    worker_memory_bytes: int = 0
    """Most memory of a worker [bytes]; 0 = 70 % of this computer's."""
    free_disk_reserve_bytes: int = 2 << 30
    """Disk space that uploads and jobs leave free [bytes]."""
    max_upload_bytes: int = 100_000_000_000
    """Largest upload [bytes]."""
    max_open_uploads: int = 16
    """Most unfinished uploads."""
    upload_stale_s: float = 7 * 86400.0
    """An upload without new data is removed after this long [s]."""
    trash_retention_s: float = 7 * 86400.0
    """A deleted project can be restored for this long [s]."""
    keep_earlier_s: float = 0.0
    """What only earlier runs of a project needed is freed this long after its last run [s]; 0 =
    never. What an approval needs stays."""

    state_folder: Path | None = None
    """Folder of the server's own files; None = ``.recon4`` in ``root``. With another one the server
    only shows ``root``, and changes nothing."""
    webhook_networks: tuple[Network, ...] = ()
    """Networks besides the internet to which webhooks may be posted."""
    sensor_bind_address: str = "0.0.0.0"
    """Address of the network interface for the sensors of a live capture; 0.0.0.0 = any."""

    def __post_init__(self) -> None:
        # Children of the server work in folders of their own.
        object.__setattr__(self, "root", self.root.absolute())
        if not self.lan:
            _refuse_open_network(self.host)
            if self.tls_certificate or self.tls_key:
                raise ConfigError(CodedText("server-certificate-lan"))
        if self.lan and self.behind is not None:
            raise ConfigError(CodedText("server-behind-lan"))
        if (self.tls_certificate is None) != (self.tls_key is None):
            raise ConfigError(CodedText("server-tls-both"))
        if is_unnameable(self.root):
            raise ConfigError(CodedText("server-root-utf8", root=visible(str(self.root))))
        if not self.root.is_dir():
            raise ConfigError(CodedText("projects-no-folder", root=str(self.root)))
        if (self.root / "project.json").exists():
            raise ConfigError(
                CodedText(
                    "projects-is-project",
                    root=str(self.root),
                    parent=str(self.root.resolve().parent),
                )
            )
        if not 0 <= self.port <= 65535:
            raise ConfigError(CodedText("server-port-range", port=self.port))

    @property
    def state(self) -> Path:
        """Folder of the server's own files: jobs, locks, thumbnails."""
        return self.state_folder or self.root / ".recon4"

    @property
    def login(self) -> bool:
        """Whether people have to sign in."""
        return self.lan or self.behind is not None

    @property
    def max_connections_of_an_address(self) -> int:
        """Most open connections per address; a proxy is one address for everybody."""
        return self.max_connections if self.behind else self.max_connections_per_address

    @property
    def read_only(self) -> bool:
        """Whether nothing in ``root`` is changed."""
        return self.state_folder is not None

    @property
    def import_roots(self) -> tuple[Path, ...]:
        """Folders recordings may lie in, resolved."""
        return tuple(dict.fromkeys(path.resolve() for path in (self.root, *self.recording_folders)))


def recording_folders_from_environment() -> tuple[Path, ...]:
    """Folders named in ``RECON4_RECORDINGS``, else the folder the server was started in."""
    named = os.environ.get("RECON4_RECORDINGS", "")
    return tuple(Path(part) for part in named.split(os.pathsep) if part) or (Path.cwd(),)


def allowed_hosts_from_environment() -> tuple[str, ...]:
    """Host names in ``RECON4_NAMES``, with commas between."""
    named = os.environ.get("RECON4_NAMES", "")
    return tuple(part.strip() for part in named.split(",") if part.strip())


def webhook_networks_from_environment() -> tuple[Network, ...]:
    """Networks in ``RECON4_WEBHOOK_NETWORKS``, with commas between: 192.168.1.0/24.

    Raises:
        ConfigError: If one is none.
    """
    named = os.environ.get("RECON4_WEBHOOK_NETWORKS", "").split(",")
    try:
        return tuple(ipaddress.ip_network(part.strip()) for part in named if part.strip())
    except ValueError as error:
        raise ConfigError(at("RECON4_WEBHOOK_NETWORKS", str(error))) from error


def worker_environment() -> dict[str, str]:
    """Environment of a child process: no secrets, one thread a library, our modules and no others.

    Python would look for modules in the folder the server was started in, where users keep files.
    """
    inherited = allowed_environment(os.environ)
    ours = (Path(recon4.__file__).parents[1], Path(__file__).parents[1])
    named = [Path(part) for part in inherited.get("PYTHONPATH", "").split(os.pathsep) if part]
    places = dict.fromkeys(str(path.resolve()) for path in (*ours, *named))
    modules = {"PYTHONPATH": os.pathsep.join(places), "PYTHONSAFEPATH": "1"}
    return {**inherited, **ONE_THREAD, **modules}


def _refuse_open_network(host: str) -> None:
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        loopback = False
    if not loopback:
        raise ConfigError(CodedText("server-host", host=host))
