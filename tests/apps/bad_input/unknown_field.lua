-- exit code: 2
-- says: displacment.x
-- says: did you mean "displacement.x"?

local model = require("plate").standing()
model:max("displacment.x") -- wrong
