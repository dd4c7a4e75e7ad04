local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local mesh = cdem.solid.cylinder{ radius = 0.5, axis = {0, 0, 2} }:mesh{ size = 0.2 }
mesh:faces{ side = "z-", name = "foot" }
local model = cdem.model{ bodies = { { name = "column", shape = mesh, material = rock } } }

-- example: cdem.select.plane
model:fix{ on = cdem.select.plane{ point = {0, 0, 2}, normal = {0, 0, 1} }, axes = "xy" }

-- example: cdem.select.box
local top = cdem.select.box{ min = {-1, -1, 1.9}, max = {1, 1, 2.1} }
model:force{ on = top, force = {0, 0, -1e6} }

-- example: cdem.select.units
local first = cdem.select.units{ body = "column", numbers = {1} } -- the first unit of a pile, or part of a mesh
print(model:mean("displacement.z", first))

-- example: cdem.select.faces
model:fix{ on = cdem.select.faces{ name = "foot" } }

-- example: cdem.select.where
local inner = cdem.select.where(function(x, y, _) return x * x + y * y < 0.2 ^ 2 end) -- undeformed places, m
print(model:max("displacement.z", inner))
