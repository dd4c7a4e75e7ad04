-- A block topples when its weight points past its edge. Contacts a tenth as stiff take a third of the steps.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/toppling/case.lua", jobs = 1,
                            set = { { width = 0.5, height = 1.5, normal_stiffness = 1e10 } } }
if results[1].exit_code ~= 0 then error("the example ended with exit code " .. results[1].exit_code) end
expect.near(results[1].figures, "topples_at_degrees", math.deg(math.atan(0.5 / 1.5)), 0.02)
expect.done()
