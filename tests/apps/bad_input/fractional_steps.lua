-- exit code: 2
-- says: max_steps = 10.5
-- says: whole number

local model = require("plate").standing()
model:relax{ max_steps = 10.5 } -- wrong
