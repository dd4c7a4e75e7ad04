local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.1}, divisions = {4, 4, 1} },
                                       material = rock, joint = joint } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }

-- example: model:after_stage
model:after_stage(function(stage) model:save{ file = "stage_" .. stage.number .. ".vtu" } end)

-- example: model:relax
local balance = model:relax{ residual = 1e-4 }
print(balance.verdict, balance.converged, balance.steps) -- "stable", true

-- example: model:run
model:clear_loads() -- otherwise the two tractions add up
model:traction{ on = "y+", stress = {0, -2e6, 0} } -- all at once: the plate rings
model:run{ duration = 1e-3, every = 20, callback = function() print(model:at("displacement.y", {0.5, 1, 0.05})) end }

-- example: model:stages
for _, stage in ipairs(model:stages()) do print(stage.kind, stage.steps) end
