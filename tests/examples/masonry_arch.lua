-- A semicircular arch of 27 dry voussoirs: the interval that holds the least thickness is halved three times, and what
-- is found agrees with the line of thrust through the same joints.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/masonry_arch/case.lua", jobs = 1,
                           set = { { halvings = 3, collapse = false } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.near(figures, "line_of_thrust_at_these_joints", 0.1075, 0.01)
expect.between(figures, "least_thickness_over_radius", 0.1071 - figures.found_to - 0.001, 0.1071 + figures.found_to + 0.001)
expect.done()
