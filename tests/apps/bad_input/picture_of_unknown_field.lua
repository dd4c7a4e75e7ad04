-- exit code: 2
-- says: "stress.yx"
-- says: did you mean stress.

local model = require("plate").standing()
model:picture{ file = "a.png", colour = "stress.yx" } -- wrong
