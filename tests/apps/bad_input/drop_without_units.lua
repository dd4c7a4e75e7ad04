-- exit code: 2
-- says: count = 0: must be
local cdem = require "cdem"
local unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
cdem.drop{ unit = unit, count = 0, onto = cdem.box_mesh{ size = {9, 9, 1}, divisions = {1, 1, 1} } } -- wrong
