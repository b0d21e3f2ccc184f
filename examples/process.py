"""Process a recording: from the packets of a walk to a map with a verdict.

The verdict is `good`, `check` or `do not use`, with its reasons. Call it again after a power cut or
Ctrl-C: it continues after the last finished stage. The result files are in the folder `walk`.
"""

from recon4 import api


def main() -> None:
    """Process the recording in the folder `recording`."""
    sources = api.Sources.of(
        "recording/recording.pcap", imu="recording/imu.csv", rig="recording/rig.toml"
    )
    try:
        project = api.process(sources, "walk", settings={"map.voxel_m": 0.05})
    except api.errors.RecordingError as error:
        raise SystemExit(f"this recording cannot be read: {error}") from error

    summary = project.summary
    print(f"{summary.path_length_m:.2f} m in {summary.duration_s:.2f} s, {summary.points} points")
    print(f"verdict: {summary.verdict.usability}")
    for finding in project.findings:
        print(f"  {finding.level}: {finding.text}")

    poses = project.trajectory  # T_map_body at t_ns
    x, y, z = poses.T_a_b.t[-1]
    print(f"{len(poses)} poses, the last at x {x:.2f} y {y:.2f} z {z:.2f} m")

    edges = project.graph.edges  # every pair of places that was compared
    print(f"{len(edges)} edges, {sum(edge.in_graph for edge in edges)} of them used")


if __name__ == "__main__":
    main()
