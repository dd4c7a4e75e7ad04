-- The soil slope on a mesh of a tenth of its height, which finds 1.48 of 1.4, and the toppling blocks.
local cdem = require "cdem"
local expect = require "expect"

local soil = cdem.sweep{ script = "../../examples/slope_stability/case.lua", jobs = 1,
                         set = { { zones = 8, tolerance = 0.1 } } }[1]
local blocks = cdem.sweep{ script = "../../examples/slope_stability/toppling.lua", jobs = 1,
                           set = { { tolerance = 0.05 } } }[1]
for _, result in ipairs{ soil, blocks } do
  if result.exit_code ~= 0 then error("an example ended with exit code " .. result.exit_code) end
end
expect.between(soil.figures, "factor_of_safety_upper", 1.45, 1.6)
expect.near(blocks.figures, "tan_phi_that_just_holds", 0.7855, 0.002)
expect.near(blocks.figures, "factor_of_safety", 1.2, 0.05)
expect.done()
