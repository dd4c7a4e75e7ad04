-- An earthquake in 20 m of soil: with elements of 2 m the first peak of the amplification is that of the formula.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/seismic_column/case.lua", jobs = 1, set = { { zone = 2, after = 3 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
expect.near(result.figures, "first_peak", 3.608, 0.05)
expect.near(result.figures, "first_peak_at", 2.5, 0.05)
expect.between(result.figures, "energy_balance_error", 0, 2e-3)
expect.done()
