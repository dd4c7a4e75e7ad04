-- A tunnel in 24 sectors, dug without bolts: stress and convergence of the wall are Kirsch's.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/tunnel/case.lua", jobs = 1, set = { { sectors = 24, bolts = false } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
expect.between(result.figures, "hoop_stress_over_kirsch", 0.97, 1.03)
expect.between(result.figures, "convergence_over_kirsch", 0.97, 1.03)
expect.done()
