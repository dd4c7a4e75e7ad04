-- exit code: 2
-- says: name = "rot": no faces of body "units" have that name; did you mean root? There are: root
local cdem = require "cdem"
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
unit:faces{ side = "z-", name = "root" }
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = unit, material = concrete, name = "units" } } }
model:fix{ on = cdem.select.faces{ body = "units", name = "rot" } } -- wrong
