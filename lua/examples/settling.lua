local cdem = require "cdem"
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
local floor = cdem.solid.box{ size = {6, 6, 1}, origin = {0, 0, -1} }:mesh{ size = 1 }
local pile = cdem.drop{ unit = unit, count = 2, onto = floor }
local model = cdem.model{ bodies = { { name = "units", shape = pile, material = concrete },
                                     { name = "floor", shape = floor, material = concrete } },
                          contacts = { default = cdem.coulomb{ friction_angle = 35 } } }
model:fix{ on = "floor" }
model:gravity{ vector = {0, 0, -9.81} }

-- example: model:settle
local rest = model:settle{ kinetic_energy_ratio = 1e-3, max_time = 5 }
print(rest.converged, rest.time) -- s of the model

-- example: model:watch
local left = model:watch{ body = "units", leaves = 0.5 } -- m
model:flow{ direction = {1, 0, 0}, velocity = 20, on = "units" }
model:run{ duration = 0.2, stop = function() return #left > 0 end }
for _, departure in ipairs(left) do print(departure.unit, departure.time) end
