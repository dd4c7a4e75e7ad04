-- The slope of the tutorial with a wide bracket and no run-out: plane sliding, F = tan(40) / tan(35) = 1.198.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/rock_slope/case.lua", jobs = 1,
                           set = { { runout = 0, tolerance = 0.05 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
expect.between(result.figures, "factor_of_safety_lower", 1.1, 1.21)
expect.between(result.figures, "factor_of_safety_upper", 1.19, 1.26)
expect.done()
