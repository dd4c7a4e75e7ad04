local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.1}, divisions = {4, 4, 1} },
                                       material = rock, joint = joint } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }
model:relax{ residual = 1e-4 }

-- example: model:save
model:save{ file = "plate.vtu", series = "plate.pvd" } -- ParaView; the series has the times
model:save{ file = "plate.vtkhdf" } -- the same as HDF5
model:save{ file = "large.vtu", cells_per_file = 100 } -- large.pvtu, which lists large/large_0.vtu and others

-- example: model:save_cracks
model:save_cracks{ file = "cracks.vtp" }

-- example: model:save_joints
model:save_joints{ file = "joints.vtp" }

-- example: model:picture
model:picture{ file = "stress.png", colour = "stress.yy", deformation = 1000, title = "Vertical stress" }
model:picture{ file = "iso.png", colour = "displacement.magnitude", view = "iso", up = "z", size = {1600, 0} }

-- example: model:film
model:film{ file = "push.ogv", steps = 50, colour = "velocity.y", range = {-1, 1}, size = {400, 300} }
model:run{ steps = 100 } -- a frame where the film begins and two more: push/000000000.png ... and push.ogv

-- example: cdem.film
local frames = {}
for i = 1, 3 do
  frames[i] = ("frame_%d.png"):format(i)
  model:picture{ file = frames[i], colour = "displacement.y", deformation = 500 * i, size = {400, 300},
                 range = {-1e-4, 0}, fit = { min = {0, 0, 0}, max = {1, 1, 0.1} } } -- the same in all frames
end
cdem.film{ file = "film.ogv", frames = frames, frames_per_second = 2 }
