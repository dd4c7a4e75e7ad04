local cdem = require "cdem"
local mesh = cdem.solid.box{ size = {2, 1, 1} }:mesh{ size = 0.5 }

-- example: cdem.box_mesh
local regular = cdem.box_mesh{ size = {2, 1, 1}, divisions = {4, 2, 2} } -- six tetrahedra a cell
print(regular.tets) -- 96

-- example: cdem.shell_mesh
local funnel = { points = {}, triangles = {} } -- a cone of 24 sides; or cdem.read_surface{ file = "funnel.stl" }
for i = 0, 23 do
  local angle = 2 * math.pi * i / 24
  funnel.points[2 * i + 1] = { 0.2 * math.cos(angle), 0.2 * math.sin(angle), 0 }
  funnel.points[2 * i + 2] = { math.cos(angle), math.sin(angle), 1 }
  local a, b, c, d = 2 * i + 1, 2 * i + 2, (2 * i + 2) % 48 + 1, (2 * i + 2) % 48 + 2
  table.insert(funnel.triangles, { a, c, d })
  table.insert(funnel.triangles, { a, d, b })
end
local wall = cdem.shell_mesh{ surface = cdem.surface(funnel), thickness = 0.05, front = {0, 0, 0.5} }
print(wall.tets) -- 144; a body of element = "rigid" that model:fix holds

-- example: tetmesh:volume tetmesh:box
print(mesh:volume(), mesh:box().max[1]) -- 2 m3, 2 m

-- example: tetmesh:inertia
print(mesh:inertia{ density = 2400 }.mass) -- kg

-- example: tetmesh:quality
local quality = mesh:quality()
print(quality.min_radius_ratio, quality.min_height) -- a regular tetrahedron has 1

-- example: tetmesh:faces
local pushed = mesh:faces{ side = "x+", name = "pushed" } -- a place of the model: cdem.select.faces{ name = "pushed" }
print(pushed.count, pushed.area)

-- example: tetmesh:save cdem.read_mesh
mesh:save{ file = "mesh.vtu" }
local read = cdem.read_mesh{ file = "mesh.vtu" } -- gmsh's .msh and others too
print(read.tets)

-- example: tetmesh:picture
mesh:picture{ file = "mesh.png", view = "iso", up = "z", edges = "mesh", colour = "radius_ratio", size = {800, 600} }
