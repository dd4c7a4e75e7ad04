-- exit code: 2
-- says: file = "../plate.vtu"
-- says: output folder

local model = require("plate").standing()
model:save{ file = "../plate.vtu" } -- wrong
