-- exit code: 2
-- says: not from a callback

local model = require("plate").standing()
model:relax{ every = 1, callback = function() model:relax{} end } -- wrong
