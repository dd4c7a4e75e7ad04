-- A coarse mesh of the notched beam, led past its peak: the load is that of the fictitious crack, as far as five
-- tetrahedra through the ligament can tell, and the ledger closes.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/three_point_bending/case.lua",
                            set = { { sizes = {0.02}, periods = 4, deflection = 2.4e-4 } } }
if results[1].exit_code ~= 0 then error("the example ended with exit code " .. results[1].exit_code) end
local figures = results[1].figures
expect.near(figures, "peak_load_N_20_mm", 2184, 0.15)
expect.between(figures, "energy_balance_error_20_mm", 0, 1e-3)
expect.between(figures, "largest_kinetic_over_elastic_20_mm", 0, 0.1)
expect.done()
