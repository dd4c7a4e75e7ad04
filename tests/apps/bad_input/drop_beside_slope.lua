-- exit code: 2
-- says: region = {30, 0} to {40, 4}: must be over the ground
local cdem = require "cdem"
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
local slope = cdem.slope{ gradient = 0.5, length = 10, width = 8 }:mesh{ size = 4 }
cdem.drop{ unit = unit, count = 5, onto = slope, region = { min = {30, 0}, max = {40, 4} } } -- wrong
