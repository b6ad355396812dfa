"""The wiggly system (eq. 2.7): vector field, stiff solver, guards, trajectories."""
