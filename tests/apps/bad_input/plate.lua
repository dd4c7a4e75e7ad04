-- What the wrong scripts share: a small plate that stands on y-.
local cdem = require "cdem"

local plate = {}
plate.rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
plate.joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
plate.shape = cdem.grid{ size = {0.2, 0.2, 0.1}, divisions = {2, 2, 1} }

function plate.model()
  return cdem.model{ bodies = { { shape = plate.shape, material = plate.rock, joint = plate.joint, name = "plate" } } }
end

function plate.standing()
  local model = plate.model()
  model:fix{ on = "y-", axes = "xyz" }
  model:traction{ on = "y+", stress = {0, -1e6, 0} }
  return model
end

return plate
