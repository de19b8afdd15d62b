"""A record at a glance: verdicts and the few figures behind them."""
