"""One definition of a mechanism's kinematics, read into a graph and printed for many machines."""
