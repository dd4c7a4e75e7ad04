-- A coarse prism between smooth platens, led just past its peak: it bears what Mohr and Coulomb say and the ledger closes.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/compression/case.lua",
                            set = { { sizes = {0.03}, shortening = 1.4e-3, speed = 0.3, pictures = false } } }
if results[1].exit_code ~= 0 then error("the example ended with exit code " .. results[1].exit_code) end
local figures = results[1].figures
expect.near(figures, "peak_over_mohr_coulomb_30_mm", 1, 0.07)
expect.between(figures, "stress_at_the_end_over_peak_30_mm", 0, 0.9)
expect.between(figures, "kinetic_over_elastic_at_peak_30_mm", 0, 0.02)
expect.between(figures, "energy_balance_error_30_mm", 0, 1e-2)
expect.done()
