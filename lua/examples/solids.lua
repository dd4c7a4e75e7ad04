local cdem = require "cdem"
local concrete = cdem.solid.box{ size = {1, 1, 1} }

-- example: cdem.solid.box
local slab = cdem.solid.box{ size = {4, 2, 0.3}, origin = {-2, -1, 0} }
print(slab:volume()) -- 2.4 m3

-- example: cdem.solid.cylinder
local core = cdem.solid.cylinder{ radius = 0.025, axis = {0, 0, 0.1} }
print(core:volume())

-- example: cdem.solid.cone
local cone = cdem.solid.cone{ radius = 0.5, top_radius = 0.2, axis = {0, 0, 1} }
print(cone:volume())

-- example: cdem.solid.sphere
local ball = cdem.solid.sphere{ radius = 0.6, centre = {0.5, 0.5, 0.5} }
print(ball:volume())

-- example: cdem.solid.union
local joined = cdem.solid.union{ solids = { slab, concrete } }
print(joined:volume())

-- example: cdem.solid.cut
local hollow = cdem.solid.cut{ solid = concrete, tools = { ball } }
print(hollow:volume())

-- example: cdem.solid.common
local rounded = cdem.solid.common{ solid = concrete, other = ball }
print(rounded:volume())

-- example: cdem.solid.fragments
local inclusion = cdem.solid.sphere{ radius = 0.3, centre = {0.5, 0.5, 0.5} }
local pieces = cdem.solid.fragments{ solids = { concrete, inclusion } } -- two regions of one mesh
print(#pieces:regions())

-- example: solid:volume solid:box solid:regions
print(pieces:volume(), pieces:box().max[3], pieces:regions()[1])

-- example: solid:inertia
local inertia = core:inertia{ density = 2400 }
print(inertia.mass, inertia.principal[1]) -- kg, kg m2

-- example: solid:mesh
local mesh = concrete:mesh{ size = 0.3, refine = { { at = {0, 0, 0}, size = 0.1, radius = 0.1 } } }
print(mesh.tets, mesh:quality().min_radius_ratio)

-- example: solid:translate solid:rotate solid:scale
local other = core:translate{ shift = {1, 0, 0} }:rotate{ axis = {0, 0, 1}, angle = 90 }:scale{ factor = 2 }
print(other:box().max[2])

-- example: solid:save cdem.solid.read
hollow:save{ file = "hollow.step" }
local read = cdem.solid.read{ file = "hollow.step" }
print(read:volume() / hollow:volume()) -- 1
