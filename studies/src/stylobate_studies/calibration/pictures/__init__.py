"""The picture of a calibration: the measured motion beside the computed one."""
