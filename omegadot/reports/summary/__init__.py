"""What a record shows at first sight: verdicts and the few figures behind them."""
