"""A recording with another IMU or rig."""


class Walk:
    """A recording with another IMU or rig."""

    def __init__(self, frames, *, imu=None, rig=None):
        self._frames, self.imu, self.rig = frames, imu or frames.imu, rig or frames.rig
        self.t_mid_ns = frames.t_mid_ns

    def __len__(self):
        return len(self._frames)

    def __getitem__(self, k):
        return self._frames[k]

    def with_imu(self, imu):
        return Walk(self._frames, imu=imu, rig=self.rig)
