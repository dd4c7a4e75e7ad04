-- exit code: 2
-- says: max_steps = 0: must be >= 1

local model = require("plate").standing()
model:relax{ max_steps = 0 } -- wrong
