local cdem = require "cdem"
local unit = cdem.cube{ height = 1 }:mesh{ size = 0.8 }
local slope = cdem.slope{ gradient = 1 / 1.5, length = 9, width = 8 }:mesh{ size = 2 }

-- example: cdem.drop
local hung = cdem.drop{ unit = unit, count = 6, onto = slope, seed = 2 } -- to be let fall by model:settle
print(hung.count)

-- example: pile:walls
local walls = hung:walls{ onto = slope } -- shape of a rigid body beside the slope and the units
print(walls.parts)

-- example: cdem.place
local layer = cdem.place{ unit = unit, count = 6, onto = slope, attitudes = 20, nudges = 0 }
print(layer.nominal_diameter)
local two = cdem.place{ unit = unit, count = 12, layers = 2, columns = 3, onto = slope, attitudes = 20, nudges = 0 }
print(#two) -- units 1 to 6 are the lower layer; 1 to 3 and 7 to 9 are the lowest rows, to be held

-- example: pile:scaled
local model_scale = layer:scaled{ factor = 1 / 40 }
print(model_scale.height)

-- example: pile:with_unit
local finer = layer:with_unit{ unit = cdem.cube{ height = 1 }:mesh{ size = 0.4 } }
print(finer.count)

-- example: pile:poses pile:box
for _, pose in ipairs(layer:poses()) do print(pose.centroid[3]) end -- m
print(layer:box().max[3])

-- example: pile:save cdem.read_pile
layer:save{ file = "layer.json" }
local again = cdem.read_pile{ file = "layer.json" }
print(again.count)
