"""The replay page: what a run was like frame by frame, as one HTML file that needs nothing else."""
