local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local model = cdem.model{ bodies = { { name = "plate", shape = cdem.grid{ size = {1, 1, 0.1}, divisions = {4, 4, 1} },
                                       material = rock, joint = joint } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }

-- example: model:probe
model:probe{ name = "top", field = "displacement.y", at = {0.5, 1, 0.05} }

-- example: model:record_reaction
model:record_reaction{ name = "foot", on = "y-" }

-- example: model:record_momentum
model:record_momentum{ name = "plate", body = "plate" }

-- example: model:history
model:run{ duration = 5e-4 }
model:relax{ residual = 1e-4 }
local history = model:history()
print(#history.time, history.top[#history.top]) -- the same is in history.csv

-- example: model:fields
print(table.concat(model:fields(), " "))

-- example: model:max model:min model:mean
print(model:max("displacement.magnitude"), model:min("stress.yy"), model:mean("stress.yy", "y+"))

-- example: model:find_max model:find_min
local worst = model:find_max("principal_stress.1") -- tension is positive
print(worst.value, worst.place[1], worst.place[2])
print(model:find_min("displacement.y").value)

-- example: model:at
print(model:at("displacement.y", {0.5, 1, 0.05})) -- m

-- example: model:reaction
print(model:reaction("y-")[2]) -- 1e5 N

-- example: model:energy
local energy = model:energy()
print(energy.elastic, energy.balance_error)

-- example: model:overlap
print(model:overlap().volume)

-- example: model:blocks
for _, block in ipairs(model:blocks()) do
  if block.centroid[2] > 0.8 then print(block.stress[2]) end -- yy, Pa
end

-- example: model:breaks
print(#model:breaks()) -- 0
