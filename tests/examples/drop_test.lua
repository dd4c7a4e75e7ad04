-- Drop tests, shortened: a cube that falls flat presses on a rigid floor with rho c v A and leaves it; a brittle cube breaks
-- between two heights, and its eightfold is not far from that: a brittle law has no length.
local cdem = require "cdem"
local expect = require "expect"

local flat = cdem.sweep{ script = "../../examples/drop_test/flat.lua", set = { { divisions = 6 } } }[1]
if flat.exit_code ~= 0 then error("flat.lua ended with exit code " .. flat.exit_code) end
expect.near(flat.figures, "force_over_rho_c_v_a", 1, 0.03)
expect.between(flat.figures, "peak_over_rho_c_v_a", 1, 1.1)
expect.between(flat.figures, "energy_balance_error", 0, 0.01)

local small = { fineness = 2.0, low = 0.004, pictures = false, bisections = 6, fracture_energy = 0, floor = "rigid",
                mass = 2000.0 }
local large = {}
for name, value in pairs(small) do large[name] = value end
large.mass = 16000.0
local drops = cdem.sweep{ script = "../../examples/drop_test/case.lua", set = { small, large } }
for _, drop in ipairs(drops) do
  if drop.exit_code ~= 0 then error("case.lua ended with exit code " .. drop.exit_code) end
  expect.between(drop.figures, "whole_at_m", 0, 10)
  expect.between(drop.figures, "energy_balance_error", 0, 0.02)
end
expect.near(drops[2].figures, "critical_height_m", drops[1].figures.critical_height_m, 0.02)
expect.done()
