"""What every study starts from: the plan of a run, canonical recordings, wrist kinematics."""
