"""The doors of the optimisation libraries; nothing else imports them."""
