-- exit code: 2
-- says: attempt to perform arithmetic on a nil value (field 'count')

local model = require("plate").standing()
local notes = {}
model:relax{ every = 1, callback = function() return notes.count + 1 end } -- wrong
