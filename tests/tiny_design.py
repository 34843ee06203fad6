"""A design of two voxels that carry their weight: a whole run takes milliseconds."""

#: Without a name, which stands before it.
TINY = """
voxel_size = "5 mm"
[shapes]
body = { kind = "box", size = ["5 mm", "5 mm", "= height"] }
[parameters]
height = { value = "10 mm", min = "5 mm", max = "10 mm", step = "5 mm" }
[materials]
m = { model = "neo-hookean", young = "100 kPa", poisson = 0.3, density = "1000 kg/m^3" }
[[parts]]
shape = "body"
material = "m"
[[clamps]]
region = { z = ["0 mm", "0 mm"] }
[[loads]]
kind = "gravity"
[probes]
top = { z = ["-1 m", "1 m"] }
[objectives.rise]
maximize = "displacement"
probe = "top"
axis = "z"
"""
