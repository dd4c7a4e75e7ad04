local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local function plate(pressure) -- negative: tension
  local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.25}, divisions = {4, 4, 1} },
                                         material = rock, joint = joint, element = "small_strain" } } }
  model:fix{ on = {"z-", "z+"}, axes = "z" }
  model:fix{ on = "y-" }
  model:traction{ on = "y+", stress = {0, -pressure, 0} }
  return model
end

-- example: model:refine
local model = plate(25e6)
model:relax{ residual = 1e-4, breaking = false }
local cuts = model:refine{ shear_threshold = 0.7e6 } -- blocks this near to failure are cut along their failure plane
model:relax{ residual = 1e-4 }                       -- and may break
for _, cut in ipairs(cuts) do print(cut.centroid[1], cut.normal[1], cut.normal[2]) end

-- example: model:grow
local notched = plate(-3e6)
notched:break_bonds{ on = cdem.select.box{ min = {0, 0.5, 0}, max = {0.25, 0.5, 0.25} }, whole_faces = true }
local grown = notched:grow{ passes = 1, residual = 1e-4, max_rounds = 3 }
print(#grown.passes, grown.state)
