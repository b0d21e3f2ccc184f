"""Trajectories as text whose first line names their columns as EuRoC and ROS exports do."""

import pytest

from recon4.recording.formats.poses import read_tum


@pytest.mark.parametrize(
    "names",
    [
        "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
        "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []",
        "time,position_x,position_y,position_z,"
        "orientation_w,orientation_x,orientation_y,orientation_z",
    ],
)
def test_a_quaternion_whose_names_begin_with_w_is_not_taken_as_x_first(tmp_path, names):
    path = tmp_path / "a.tum"
    path.write_text(
        f"{names}\n1403636580838555648,1,2,3,0.5,0.5,0.5,-0.5\n1403636580938555648,1,2,3,0.8,0.6,0,0\n"
    )

    found = read_tum(path)

    assert found.t_ns[0] == 1403636580838555648
    assert found.T_a_b.quat_xyzw()[1] == pytest.approx([0.6, 0.0, 0.0, 0.8])
