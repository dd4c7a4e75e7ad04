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

-- example: cdem.surface cdem.clip
local points, triangles = {}, {}
for i = 0, 10 do
  for j = 0, 10 do points[#points + 1] = { i, j, 3 + math.sin(0.5 * i) * math.cos(0.4 * j) } end
end
for i = 0, 9 do
  for j = 1, 10 do
    local a = 11 * i + j
    triangles[#triangles + 1], triangles[#triangles + 2] = { a, a + 11, a + 12 }, { a, a + 12, a + 1 }
  end
end
local terrain = cdem.surface{ points = points, triangles = triangles }
local hill = cdem.clip{ shape = cdem.grid{ size = {10, 10, 5}, divisions = {4, 4, 2} }, surface = terrain, keep = "below",
                        tolerance = 0.2 }
local shaft = cdem.solid.cylinder{ radius = 1.5, axis = {0, 0, 10}, base = {5, 5, -1} }
hill = cdem.clip{ shape = hill, solid = shaft, keep = "outside", tolerance = 0.3 }
print(#hill, hill:volume())

-- example: cdem.read_surface surface:area surface:closed surface:box
local faces <close> = assert(io.open("ramp.dxf", "w")) -- in the output folder
local corners = { {0, 0, 1}, {10, 0, 3}, {10, 10, 3}, {0, 10, 1} }
faces:write("0\nSECTION\n2\nENTITIES\n0\n3DFACE\n")
for i, x in ipairs(corners) do
  for axis = 1, 3 do faces:write(10 * axis + i - 1, "\n", x[axis], "\n") end
end
faces:write("0\nENDSEC\n0\nEOF\n")
faces:flush()
local ramp = cdem.read_surface{ file = "ramp.dxf" }
print(#ramp, ramp:area(), ramp:closed(), ramp:box().max[3]) -- 2 triangles
