-- exit code: 2
-- says: duration: missing

local model = require("plate").standing()
model:run{ breaking = false } -- wrong
