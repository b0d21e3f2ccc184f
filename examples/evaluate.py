"""Evaluate a result against ground truth: the trajectory, and the distance of the map to a model.

The truth may be of a simulation, of a motion capture system or of another program, as a TUM file
(`seconds x y z qx qy qz qw`) at any rate and in any frame.
"""

from recon4 import api


def main() -> None:
    """Compare the walk with its truth."""
    found = api.evaluate("walk", "recording/truth.tum", model="recording/model.ply")
    position = found.aligned.position_m
    print(f"{found.poses} poses over {found.path_length_m:.1f} m")
    print(f"ATE: RMSE {100 * position.rmse:.1f} cm, largest {100 * position.maximum:.1f} cm")
    if found.relative:
        print(f"map to model (e_r): {100 * found.relative.plain_mean_m:.1f} cm")

    drifted = api.evaluate("walk/odometry.tum", "recording/truth.tum")
    print(f"before loop closure: RMSE {100 * drifted.aligned.position_m.rmse:.1f} cm")


if __name__ == "__main__":
    main()
