-- exit code: 2
-- says: figures[1].kind = "guess"
-- says: "formula", "paper", "fe", "trial"

local cdem = require "cdem"
cdem.report{ { name = "ux_m", value = 1, reference = 2, kind = "guess" } } -- wrong
