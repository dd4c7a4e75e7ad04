-- The beam of the tutorial on its coarser mesh: the peak is that of the fictitious crack as far as five tetrahedra through
-- the ligament can tell (case.lua's test), the load has fallen behind it, the ledger closes.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/three_point_bending/simple.lua", set = { { size = 0.02 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "peak_load", 2184, 1.2 * 2184)
expect.between(figures, "last_load", 0, 0.6 * 2184)
expect.between(figures, "crack_energy", 0, 124 * 0.1 * 0.05) -- below G_I times the ligament: not through yet
expect.between(figures, "energy_balance_error", 0, 1e-3)
expect.done()
