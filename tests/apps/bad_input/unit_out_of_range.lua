-- exit code: 2
-- says: numbers = 4: must be a unit of "units", which has 3
local cdem = require "cdem"
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
local pile = cdem.drop{ unit = unit, count = 3, onto = cdem.box_mesh{ size = {9, 9, 1}, divisions = {1, 1, 1} } }
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = pile, material = concrete, name = "units" } } }
model:fix{ on = cdem.select.units{ body = "units", numbers = {4} } } -- wrong
