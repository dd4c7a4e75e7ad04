-- exit code: 2
-- says: residual = 0: must be in (0, 1)

local model = require("plate").standing()
model:relax{ residual = 0 } -- wrong
