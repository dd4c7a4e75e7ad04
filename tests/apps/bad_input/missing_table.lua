-- exit code: 4
-- says: nowhere.csv
-- says: not found

local cdem = require "cdem"
cdem.read_csv("nowhere.csv") -- wrong
