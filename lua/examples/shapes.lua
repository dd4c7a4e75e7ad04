local cdem = require "cdem"

-- example: cdem.grid
local plate = cdem.grid{ size = {0.3, 0.3, 0.03}, divisions = {10, 10, 1} } -- 100 blocks
print(#plate)

-- example: cdem.box
local block = cdem.box{ size = {1, 2, 0.5}, origin = {0, 0, 1} }
print(block:volume()) -- 1 m3

-- example: cdem.voronoi
local rock = cdem.voronoi{ size = {10, 10, 10}, count = 50, seed = 3 }
print(#rock)

-- example: cdem.bricks
local wall = cdem.bricks{ size = {2, 0.1, 1}, brick = {0.25, 0.1, 0.1} }
print(#wall)

-- example: cdem.cut_by_joints
local jointed = cdem.cut_by_joints{ shape = cdem.box{ size = {20, 10, 10} }, seed = 7, sets = {
  { name = "bedding", dip = 20, dip_direction = 90, spacing = 2 },
  { name = "cross", dip = 75, dip_direction = 270, spacing = 4, spacing_scatter = 0.2 } } }
print(#jointed)

-- example: cdem.cut_by_discs
local cracked = cdem.cut_by_discs{ shape = cdem.grid{ size = {10, 10, 10}, divisions = {3, 3, 3} }, discs = {
  { centre = {5, 5, 5}, dip = 45, dip_direction = 90, radius = 3, set = "fracture" } } }
print(#cracked)

-- example: cdem.read_discs
local file <close> = assert(io.open("discs.csv", "w")) -- in the output folder
file:write("id,x,y,z,dip,dip_direction,radius,set\n", "1,3,5,5,30,90,2,a\n", "2,7,5,6,60,180,3,b\n")
file:flush()
local discs = cdem.read_discs("discs.csv")
local network = cdem.cut_by_discs{ shape = cdem.box{ size = {10, 10, 10} }, discs = discs }
print(#discs, #network)

-- example: cdem.random_discs cdem.disc_statistics
local room = { min = {-3, -3, -3}, max = {13, 13, 13} } -- larger than the rock by the largest radius
local fractures = cdem.random_discs{ box = room, seed = 5, sets = {
  { set = "a", dip = 30, dip_direction = 90, kappa = 40, p32 = 0.4,
    radius = { law = "power", exponent = 2.5, smallest = 1, largest = 3 } },
  { set = "b", dip = 80, dip_direction = 200, kappa = 25, p30 = 0.01, radius = { mean = 2 } } } }
for _, s in ipairs(cdem.disc_statistics{ discs = fractures, box = { min = {0, 0, 0}, max = {10, 10, 10} },
                                         line = { from = {0, 5, 5}, to = {10, 5, 5} } }) do
  print(s.set, s.count, s.dip, s.kappa, s.p32, s.p10)
end

-- example: cdem.convex_hull
local wedge = cdem.convex_hull{ points = { {0, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 1, 0}, {2, 1, 0}, {0, 1, 1} } }
print(wedge:volume()) -- 1 m3

-- example: cdem.blocks
local tetrahedra = cdem.blocks{ mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} } }
print(#tetrahedra) -- 48

-- example: cdem.cut_by_plane
local halves = cdem.cut_by_plane{ shape = block, point = {0.5, 0, 0}, normal = {1, 0, 0}, name = "fault" }
print(#halves) -- 2; the law of their face: joints = { fault = ... }

-- example: cdem.keep
local lower = cdem.keep{ shape = plate, inside = { min = {0, 0, 0}, max = {0.3, 0.15, 0.03} } }
print(#lower) -- 50

-- example: cdem.translate
local moved = cdem.translate{ shape = block, shift = {0, 0, 2} }
print(moved:box().min[3]) -- 3

-- example: cdem.rotate
local turned = cdem.rotate{ shape = block, axis = {0, 1, 0}, angle = 30, centre = {0.5, 1, 1.25} }
print(turned:box().max[3])

-- example: cdem.merge
local both = cdem.merge{ shapes = { block, moved } }
print(#both) -- 2

-- example: assembly:volume assembly:box
local box = jointed:box()
print(jointed:volume(), box.max[1] - box.min[1]) -- m3, m

-- example: assembly:joint_sets
print(table.concat(jointed:joint_sets(), ", ")) -- bedding, cross

-- example: assembly:blocks
local largest = 0
for _, one in ipairs(jointed:blocks()) do largest = math.max(largest, one.volume) end
print(largest) -- m3

-- example: assembly:solid
local mesh = rock:solid():mesh{ size = 3 } -- one mesh; its regions are the blocks
print(mesh.tets)
