-- exit code: 2
-- says: error value is a table

error({}) -- wrong
