"""The tick loop: from blocks to rows of joint values that keep every bound in force.

`Pacer` takes one block after another; a move becomes `MotionRows`, a switch changes the options.
"""
