"""One task for irlx and others beside it, each in a process, judged by kinematics of its own."""
