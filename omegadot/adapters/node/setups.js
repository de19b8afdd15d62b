// Setups: 'physics', 'as-shipped', and 'as-shipped+NAME', which mends one of a description's settings.
'use strict';

const mends = (setup, name) => setup === 'physics' || setup === `as-shipped+${name}`;

module.exports = { mends };
