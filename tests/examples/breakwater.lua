-- The small breakwater of the tutorial, still smaller, until its first unit leaves.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/breakwater/case.lua", set = { { count = 8, columns = 2 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "kinetic_ratio_at_rest", 0, 1e-4)
expect.between(figures, "energy_balance_error", 0, 0.01)
expect.between(figures, "deepest_contact_over_height", 0, 0.01)
-- rho V^2 / 2 on the silhouette of a unit of H^2 carries its weight under water up a frictionless slope of 1:1.5 at 3.1 m/s;
-- on a third of it, with friction of 35 degrees, at 7.7 m/s. Neighbours hold it back for longer.
expect.between(figures, "unit_1_leaves_at", 3.1, 15)
expect.done()
