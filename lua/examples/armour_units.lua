local cdem = require "cdem"

-- example: cdem.accropode
local unit = cdem.accropode{ mass = 16e3, density = 2400, mesh_size = 0.6 } -- 16 t
print(unit.height, unit:mesh{}.tets)

-- example: cdem.dolos
local dolos = cdem.dolos{ height = 2 }
print(dolos:volume()) -- m3

-- example: cdem.tetrapod
local tetrapod = cdem.tetrapod{ height = 2, mesh_size = 0.5 }
print(tetrapod:volume())

-- example: cdem.cube
local cube = cdem.cube{ mass = 20e3, density = 2400 }
print(cube.height)

-- example: cdem.antifer
local antifer = cdem.antifer{ height = 2 }
print(antifer:volume())

-- example: cdem.cubipod
local cubipod = cdem.cubipod{ mass = 16e3, density = 2400 }
print(cubipod.height) -- 2.31 m

-- example: cdem.slope
local ground = cdem.slope{ gradient = 1 / 1.5, length = 12, width = 8 }
print(ground:box().max[3]) -- 8 m
