-- exit code: 2
-- says: no outer face of the mesh lies there
-- says: {0, 0, 0} to {1, 1, 1}

local cdem = require "cdem"
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
mesh:faces{ plane = { point = {0.5, 0, 0}, normal = {1, 0, 0} } } -- wrong
