-- A pulse in a bar: the slab flies off where, when and as fast as waves in a bar say, as far as its fracture energy lets it.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/spall/case.lua", set = { { cells = 200 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.near(figures, "place_m", 0.8333, 0.02)
expect.near(figures, "time_s", 344.1e-6, 0.05)
expect.near(figures, "velocity_m_per_s", 0.9428, 0.1)
expect.between(figures, "energy_balance_error", 0, 2e-3)
expect.done()
