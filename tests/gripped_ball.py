"""A small gripper: two pads close on a ball, lift it and hold it by friction alone."""

GRIPPER = """
schema = "voxsoft/1"
name = "gripper"
voxel_size = "2 mm"
[parameters]
squeeze = { value = "0.5 mm", min = "0.2 mm", max = "1 mm" }
[shapes]
pad = { kind = "box", size = ["4 mm", "8 mm", "8 mm"], center = ["6 mm", 0, 0] }
other = { kind = "mirror", of = "pad", normal = "x" }
pads = { kind = "union", of = ["pad", "other"] }
ball = { kind = "sphere", radius = "3.9 mm" }
[materials]
rubber = { model = "neo-hookean", young = "1 MPa", poisson = 0.45, density = "1100 kg/m^3" }
[[parts]]
shape = "pads"
material = "rubber"
[[objects]]
name = "ball"
shape = "ball"
motion = "free"
mass = "5 g"
voxel_size = "1 mm"
[[clamps]]
region = { x = ["8 mm", "8 mm"] }
motion.displacement = ["= -squeeze", 0, "2 mm"]
motion.history = { time = [0, "0.05 s"], factor = [0, 1] }
[[clamps]]
region = { x = ["-8 mm", "-8 mm"] }
motion.displacement = ["= squeeze", 0, "2 mm"]
motion.history = { time = [0, "0.05 s"], factor = [0, 1] }
[[loads]]
kind = "gravity"
history = { time = ["0.05 s", "0.1 s"], factor = [0, 1] }
[contact]
friction = 0.8
[objectives]
grip = { maximize = "grip_force", object = "ball" }
[solver]
method = "dynamics"
time_step = "10 ms"
end_time = "0.15 s"
"""
