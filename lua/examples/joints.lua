local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local shape = cdem.cut_by_joints{ shape = cdem.box{ size = {4, 4, 4} }, sets = {
  { name = "bedding", dip = 10, dip_direction = 90, spacing = 2 } } }
local model = cdem.model{ bodies = { { name = "rock", shape = shape, material = rock,
                                       joint = cdem.coulomb{ friction_angle = 40 } } } }
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -9.81} }
model:relax{ residual = 1e-4 }

-- example: model:joints
for _, set in ipairs(model:joints{}) do
  print(set.set, set.area, set.normal_traction, set.utilisation) -- m2, Pa, traction over strength
end

-- example: model:joint_points
local points = model:joint_points{ sets = {"bedding"} }
print(#points.normal_traction)
