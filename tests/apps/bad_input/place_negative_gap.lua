-- exit code: 2
-- says: gap = -0.1: must be > 0
local cdem = require "cdem"
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
cdem.place{ unit = unit, count = 2, onto = cdem.box_mesh{ size = {9, 9, 1}, divisions = {1, 1, 1} }, gap = -0.1 } -- wrong
