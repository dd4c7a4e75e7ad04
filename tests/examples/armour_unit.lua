-- One set-up of the armour unit through the program, with a coarse mesh: it breaks at the root, near which the bending
-- moment is largest, and in this set-up at a higher velocity by ramp, in which inertia carries a part, than by hold.
local cdem = require "cdem"
local expect = require "expect"

local example = "../../examples/armour_unit/"
local result = cdem.sweep{ script = example .. "case.lua", set = { { fineness = 4.0 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "case_1_hold_m_per_s", 8, 30)
expect.between(figures, "case_1_ramp_m_per_s", figures.case_1_hold_m_per_s, 40)
expect.between(figures, "case_1_hold_height_fraction", 0, 1 / 3)
expect.between(figures, "principal_inertia_ratio_max", 1, 3)
expect.between(figures, "energy_balance_error", 0, 0.01)
expect.done()
