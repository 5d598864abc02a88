"""A robot that moves, in MuJoCo: any arm that a description file names, behind the `Robot` protocol."""
