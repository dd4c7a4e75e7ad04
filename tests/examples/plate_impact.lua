-- A coarse plate under twice the benchmark's tension: the crack starts when the waves of both sides have met at the notch,
-- runs slower than Rayleigh's waves, and the ledger closes.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/plate_impact/case.lua",
                            set = { { size = 2.5e-3, stress = 2e6, duration = 30e-6, pictures = false } } }
if results[1].exit_code ~= 0 then error("the example ended with exit code " .. results[1].exit_code) end
local figures = results[1].figures
expect.near(figures, "rayleigh_speed_m_per_s", 2125, 1e-3)
-- The way from the sides to the notch, 20 mm at c_d = 3810 m/s.
expect.between(figures, "starts_at_s", 20e-3 / 3810, 25e-6)
expect.between(figures, "largest_speed_over_rayleigh", 0.2, 1)
expect.between(figures, "energy_balance_error", 0, 1e-3)
expect.done()
