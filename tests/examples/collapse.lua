-- Five blocks and a row of bricks pushed off a ledge: none passes through, and energy is kept until damping begins.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/collapse/case.lua", jobs = 1,
                           set = { { blocks = 5, fall = 0.7, rest = 0, every = 10.0 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.equal(figures, "blocks_below_the_floor", 0)
expect.between(figures, "blocks_off_the_ledge", 1, 100)
expect.between(figures, "deepest_over_block_size", 0, 0.03)
expect.between(figures, "energy_balance_error_undamped", 0, 1e-3)
expect.between(figures, "overlap_over_volume", 0, 1e-5)
expect.done()
